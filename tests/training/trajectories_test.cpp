// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/trajectories.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"

#include "point_net_loss.h"
#include "trajectory_loss.h"

namespace doorforge {
namespace {

const TrajectoryShape kToyShape{.waypoints = 1,
                                .latent = 2,
                                .point_hidden = 16,
                                .point_features = 32,
                                .cloud_hidden = 24,
                                .cloud_features = 16,
                                .hidden = 32,
                                .last_hidden = 16};

std::vector<float> Scattered(std::size_t count, double scale, const std::string& stream) {
  Rng rng(13, stream);
  std::vector<float> values(count);
  for (float& value : values) value = static_cast<float>(scale * rng.Normal());
  return values;
}

// Differences of the loss itself, whose value is checked in closed form below.
TEST(ProposerLoss, HasItsGradient) {
  const TrajectoryNetworks initial = InitialTrajectoryNetworks(kToyShape, 3);
  std::vector<float> parameters = initial.proposer;
  parameters.insert(parameters.end(), initial.posterior.begin(), initial.posterior.end());
  const auto noise = Scattered(parameters.size(), 0.05, "weights");
  for (std::size_t i = 0; i < parameters.size(); ++i) parameters[i] += noise[i];
  const internal::ProposerBatch batch{
      2, Scattered(2 * 7 * kDoorPoint, 1, "points"), Scattered(2 * kTargetNumbers, 1, "targets"),
      Scattered(2 * 12, 1, "trajectory"), Scattered(2 * 2, 1, "noise")};
  const internal::ProposerWeights weights{3, 2, 0.5};
  std::vector<float> gradient(parameters.size(), 1);  // is added to
  const double loss =
      internal::ProposerLossOf(kToyShape, parameters, batch, weights, 0.25, gradient);
  EXPECT_NEAR(internal::ProposerLossOf(kToyShape, parameters, batch, weights, 1, {}), loss, 1e-4);
  int checked = 0;
  for (std::size_t i = 0; i < parameters.size(); i += 41) {
    const auto at = [&](float by) {
      std::vector<float> other = parameters;
      other[i] += by;
      return internal::ProposerLossOf(kToyShape, other, batch, weights, 1, {});
    };
    // a kink, where another point wins or a number changes sign, lies on one side at most
    const double found = (gradient[i] - 1) / 0.25;
    const double below = (at(0) - at(-1e-3F)) / 1e-3;
    const double above = (at(1e-3F) - at(0)) / 1e-3;
    const double slope = std::abs(found - below) < std::abs(found - above) ? below : above;
    EXPECT_NEAR(found, slope, 0.03 * std::abs(slope) + 0.02) << i;
    checked += std::abs(slope) > 0.1 ? 1 : 0;
  }
  EXPECT_GT(checked, 20);
}

// With all weights of the networks at zero the proposer says its last bias, and the posterior its
// own: all three terms in closed form.
TEST(ProposerLoss, IsWhatItsHeaderSays) {
  const TrajectoryNetworks initial = InitialTrajectoryNetworks(kToyShape, 3);
  const std::size_t size = initial.proposer.size();
  std::vector<float> parameters(size + initial.posterior.size(), 0);
  // says no turn of a hand as it is, and a waypoint at 1, 2, 3, 0, 0, 0
  const std::vector<float> bias = {1, 0, 0, 0, 1, 0, 1, 2, 3, 0, 0, 0};
  std::copy(bias.begin(), bias.end(),
            parameters.begin() + static_cast<std::ptrdiff_t>(size - bias.size()));
  // mean 0.5, -1 and log variance 0.2, -0.3
  const std::vector<float> code = {0.5F, -1, 0.2F, -0.3F};
  std::copy(code.begin(), code.end(), parameters.end() - 4);
  internal::ProposerBatch batch{
      1, Scattered(7 * kDoorPoint, 1, "points"), {0, 0, 0, 0}, {}, {0, 0}};
  // wanted: a quarter turn about z, the waypoint off by 1 in three of six numbers
  batch.trajectory = {0, -1, 0, 1, 0, 0, 2, 2, 2, 0, 0, 1};
  const double apart = 3.0 / 6;
  const double turned = 1.5707963;
  const double divergence = 0.5 * (0.25 + std::exp(0.2) - 1 - 0.2 + 1 + std::exp(-0.3) - 1 + 0.3);
  EXPECT_NEAR(internal::ProposerLossOf(kToyShape, parameters, batch, {10, 5, 2}, 1, {}),
              10 * apart + 5 * turned + 2 * divergence, 1e-3);
}

// The cross entropy of a sigmoid, at a network that says its last bias.
TEST(PointNetLoss, KnowsProbabilities) {
  const PointNetShape shape = AffordanceShape(kToyShape);
  std::vector<float> parameters(PointNetLayout(shape).size(), 0);
  parameters.back() = 0.4F;
  const internal::PointNetBatch batch{
      2, Scattered(2 * 7 * kDoorPoint, 1, "p"), Scattered(8, 1, "o"), {1, 0.25F}};
  const double p = 1 / (1 + std::exp(-0.4));
  std::vector<float> gradient(parameters.size(), 0);
  EXPECT_NEAR(internal::PointNetLossOf({shape, internal::PointNetError::kCrossEntropy}, parameters,
                                       batch, 1, gradient),
              -std::log(p) - 0.25 * std::log(p) - 0.75 * std::log(1 - p), 1e-5);
  EXPECT_NEAR(gradient.back(), 2 * p - 1.25, 1e-5);
}

// A network that is surely wrong learns as fast as one that is not.
TEST(PointNetLoss, TeachesWhoIsSurelyWrong) {
  const PointNetShape shape = AffordanceShape(kToyShape);
  std::vector<float> parameters(PointNetLayout(shape).size(), 0);
  parameters.back() = 30;
  const internal::PointNetBatch batch{
      1, Scattered(7 * kDoorPoint, 1, "p"), Scattered(4, 1, "o"), {0}};
  std::vector<float> gradient(parameters.size(), 0);
  EXPECT_NEAR(internal::PointNetLossOf({shape, internal::PointNetError::kCrossEntropy}, parameters,
                                       batch, 1, gradient),
              30, 1e-4);
  EXPECT_NEAR(gradient.back(), 1, 1e-6);
}

// ---- the rounds ---------------------------------------------------------------------------------

constexpr int kToySeen = 12;

// A door opens to the side on which its frame is seen, if it is held at the upper of two places.
struct ToyDoor {
  double side;
  DoorSight sight;
};

ToyDoor ToyDoorOf(std::uint64_t episode) {
  Rng rng(5, "toy/" + std::to_string(episode));
  ToyDoor door{rng.Uniform() < 0.5 ? -1.0 : 1.0, {}};
  for (int i = 0; i < kToySeen; ++i) {
    const bool frame = i % 2 == 0;
    const double y = frame ? door.side * rng.Uniform(0.4, 0.6) : 0.1 * rng.Normal();
    for (const double x : {0.0, y, 1 + 0.2 * rng.Normal()})
      door.sight.xyz.push_back(static_cast<float>(x));
    door.sight.label.push_back(
        static_cast<std::uint8_t>(frame ? PointLabel::kFrame : PointLabel::kHandle));
  }
  return door;
}

const Eigen::Vector3f kUpper(0, 0, 1.1F);
const Eigen::Vector3f kLower(0, 0, 0.9F);

// How far a door opens: half of how far the hand goes its way.
float OpeningOf(const ToyDoor& door, const Eigen::Vector3f& contact, const HandTrajectory& way) {
  if (contact != kUpper) return 0;
  return static_cast<float>(
      std::clamp(0.5 * door.side * way.waypoints[0].offset_m.y() / 0.1, 0.0, 1.5));
}

HandTrajectory RuleWay(const ToyDoor& door, Rng& rng) {
  const double right = rng.Uniform() < 0.7 ? 1 : -1;
  HandTrajectory way;
  way.waypoints.push_back({{0, right * door.side * 0.2 * rng.Uniform(0.5, 1), 0}, {0, 0, 0}});
  return way;
}

std::optional<TrajectoryTrial> PlayToy(std::uint64_t episode, const TrajectoryRater* acts) {
  if (episode % 50 == 49) return std::nullopt;  // nothing in view
  const ToyDoor door = ToyDoorOf(episode);
  Rng rng(6, "play/" + std::to_string(episode));
  TrajectoryTrial trial;
  trial.sight = door.sight;
  trial.contact_m = rng.Uniform() < 0.5 ? kUpper : kLower;
  if (acts == nullptr) {
    trial.numbers = ToNumbers(RuleWay(door, rng));
    trial.moved = rng.Uniform() < 0.9;
  } else {
    const auto proposals = acts->Propose(door.sight, {trial.contact_m, 1}, 3, rng);
    trial.numbers = proposals.numbers[0];
  }
  if (trial.moved)
    trial.opening_rad = OpeningOf(door, trial.contact_m, TrajectoryFromNumbers(trial.numbers));
  trial.opened = trial.opening_rad > 0.4F;
  return trial;
}

const TrajectoryTask kToyTask{kToySeen, PlayToy};

TrajectoryLearning ToyLearning() {
  TrajectoryLearning config;
  config.rounds = 2;
  config.episodes = 40;
  config.minibatches = 6;
  config.minibatch = 20;  // not a multiple of what a thread takes
  config.rated_proposals = 8;
  return config;
}

void ExpectSameStates(const TrajectoryState& a, const TrajectoryState& b) {
  for (const auto vector :
       {&TrajectoryState::proposer, &TrajectoryState::critic, &TrajectoryState::affordance}) {
    EXPECT_EQ((a.*vector).parameters, (b.*vector).parameters);
    EXPECT_EQ((a.*vector).second_moment, (b.*vector).second_moment);
    EXPECT_EQ((a.*vector).steps, (b.*vector).steps);
  }
  ASSERT_EQ(a.rounds.size(), b.rounds.size());
  for (std::size_t i = 0; i < a.rounds.size(); ++i)
    for (const TrajectoryColumn& column : TrajectoryColumns())
      EXPECT_EQ(a.rounds[i].*column.value, b.rounds[i].*column.value) << column.name;
}

// Where to take hold and which way to go, on doors that it has not seen.
TEST(Trajectories, AreLearnedFromTrials) {
  TrajectoryLearning config = ToyLearning();
  config.episodes = 400;
  config.minibatches = 400;
  config.rounds = 3;
  config.latent_weight = 0.2;
  config.final_rate = 0.3;
  const TrajectoryState state =
      TrainTrajectories(kToyTask, config, InitialTrajectoryState(kToyShape, 3), {}, {.threads = 2});
  ASSERT_EQ(state.rounds.size(), 3U);
  EXPECT_EQ(state.rounds[2].episodes, 1200);
  EXPECT_EQ(state.proposer.steps, 1200U);
  EXPECT_GT(state.rounds[2].success, state.rounds[0].success);
  EXPECT_LT(state.rounds[2].critic, state.rounds[0].critic);
  const TrajectoryRater rater(state.Networks());
  int opened = 0;
  int prefers_upper = 0;
  for (std::uint64_t episode = 100000; episode < 100100; ++episode) {
    const ToyDoor door = ToyDoorOf(episode);
    Rng rng(7, "judge/" + std::to_string(episode));
    const auto proposals = rater.Propose(door.sight, {kUpper, 0.8F}, 30, rng);
    const auto best = std::ranges::max_element(proposals.probability);
    const auto way = TrajectoryFromNumbers(
        proposals.numbers[static_cast<std::size_t>(best - proposals.probability.begin())]);
    opened += std::abs(OpeningOf(door, kUpper, way) - 0.8F) < 0.12F ? 1 : 0;  // as asked
    prefers_upper +=
        rater.Affordance(door.sight, {kUpper, 0.8F}) > rater.Affordance(door.sight, {kLower, 0.8F})
            ? 1
            : 0;
  }
  EXPECT_GE(opened, 85);
  EXPECT_GE(prefers_upper, 95);
}

TEST(Trajectories, AreTheSameForAnyNumberOfThreadsAndInParts) {
  const TrajectoryLearning config = ToyLearning();
  const TrajectoryState initial = InitialTrajectoryState(kToyShape, 3);
  std::vector<TrajectoryState> states;
  TrajectorySamples samples;
  TrajectoryHooks hooks{.threads = 1};
  hooks.on_round = [&](const TrajectoryState& state, const TrajectorySamples& fresh) {
    states.push_back(state);
    if (states.size() < 2) samples.Append(fresh);
  };
  const TrajectoryState one = TrainTrajectories(kToyTask, config, initial, {}, hooks);
  const TrajectoryState two = TrainTrajectories(kToyTask, config, initial, {}, {.threads = 3});
  ExpectSameStates(one, two);
  ASSERT_EQ(states.size(), 2U);
  EXPECT_EQ(samples.size(), 40U);  // the one that sees nothing is of the second round
  const TrajectoryState rest =
      TrainTrajectories(kToyTask, config, states[0], samples, {.threads = 2});
  ExpectSameStates(one, rest);
}

// A grasp that missed has the motion of one that did not, and its own rotation.
TEST(Trajectories, CompleteWhatMissed) {
  TrajectorySamples fresh;
  TrajectoryHooks hooks{.threads = 1};
  hooks.on_round = [&](const TrajectoryState&, const TrajectorySamples& added) { fresh = added; };
  TrajectoryLearning config = ToyLearning();
  config.rounds = 1;
  const TrajectoryTask task{kToySeen, [](std::uint64_t episode, const TrajectoryRater*) {
                              TrajectoryTrial trial = *PlayToy(0, nullptr);
                              trial.moved = episode != 3;
                              trial.opening_rad = trial.moved ? 1.0F : 0.0F;
                              trial.numbers.assign(12, static_cast<float>(episode));
                              return std::optional(trial);
                            }};
  TrainTrajectories(task, config, InitialTrajectoryState(kToyShape, 3), {}, hooks);
  ASSERT_EQ(fresh.size(), 40U);
  const auto missed = std::span(fresh.trajectory).subspan(3 * 12, 12);
  EXPECT_EQ(missed[5], 3);
  EXPECT_NE(missed[6], 3);
  EXPECT_EQ(missed[6], missed[11]);
}

// What is stopped in the middle of a round is as before the round.
TEST(Trajectories, StopWithTheLastRoundThatIsDone) {
  const TrajectoryLearning config = ToyLearning();
  const TrajectoryState initial = InitialTrajectoryState(kToyShape, 3);
  for (const std::size_t calls : {3U, 44U, 50U, 60U, 95U, 99U}) {
    std::size_t called = 0;
    TrajectoryHooks hooks{.threads = 1};
    hooks.stop = [&] { return ++called > calls; };
    hooks.on_round = [](const TrajectoryState&, const TrajectorySamples&) { ADD_FAILURE(); };
    ExpectSameStates(TrainTrajectories(kToyTask, config, initial, {}, hooks), initial);
  }
}

TEST(Trajectories, NeedsADoorThatOpens) {
  const TrajectoryTask task{kToySeen, [](std::uint64_t episode, const TrajectoryRater* acts) {
                              auto trial = PlayToy(episode, acts);
                              if (trial) trial->opening_rad = 0;
                              return trial;
                            }};
  EXPECT_THROW(TrainTrajectories(task, ToyLearning(), InitialTrajectoryState(kToyShape, 3), {}, {}),
               Error);
  TrajectoryLearning config;
  config.minibatch = 0;
  EXPECT_THROW(CheckTrajectoryLearning(config, "config.learning"), Error);
}

}  // namespace
}  // namespace doorforge
