// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/ppo.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"

#include "ppo_advantage.h"
#include "ppo_loss.h"

namespace doorforge {
namespace {

using internal::PpoBatch;
using internal::PpoDecision;
using internal::PpoLoss;

std::vector<float> Drawn(std::size_t count, double scale, const std::string& stream) {
  Rng rng(11, stream);
  std::vector<float> values(count);
  for (float& value : values) value = static_cast<float>(scale * rng.Normal());
  return values;
}

// ---- the network --------------------------------------------------------------------------------

// It computes the same in double precision, layer by layer from the flat vector.
std::vector<double> ReferenceMlp(const MlpShape& shape, const std::vector<float>& parameters,
                                 const std::vector<float>& input) {
  std::vector<double> x(input.begin(), input.end());
  std::size_t at = 0;
  for (const auto& [inputs, outputs] :
       {std::pair(shape.inputs, shape.hidden), std::pair(shape.hidden, shape.hidden),
        std::pair(shape.hidden, shape.outputs)}) {
    const std::size_t bias = at + static_cast<std::size_t>(inputs * outputs);
    std::vector<double> y;
    for (int o = 0; o < outputs; ++o) {
      double sum = parameters[bias + static_cast<std::size_t>(o)];
      for (int i = 0; i < inputs; ++i) sum += parameters[at++] * x[static_cast<std::size_t>(i)];
      y.push_back(bias + static_cast<std::size_t>(outputs) == parameters.size() ? sum
                                                                                : std::tanh(sum));
    }
    at = bias + static_cast<std::size_t>(outputs);
    x = y;
  }
  return x;
}

TEST(Mlp, ComputesItsLayersWithTanhBetween) {
  const MlpShape shape{5, 19, 3};
  const auto parameters = Drawn(MlpLayout(shape).size(), 0.5, "mlp");
  const auto input = Drawn(5, 1, "input");
  const auto expected = ReferenceMlp(shape, parameters, input);
  const auto found = Mlp(shape, parameters)(input);
  ASSERT_EQ(found.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 1e-5);
  EXPECT_THROW(Mlp(shape, std::span(parameters).first(10)), Error);
  EXPECT_THROW(Mlp(shape, parameters)(std::vector<float>(4)), Error);
}

// ---- advantages ---------------------------------------------------------------------------------

// The definition: the sum over what is left of the episode, each weight by itself.
double AdvantageBySum(const std::vector<PpoDecision>& decisions, std::size_t at, double gamma,
                      double lambda) {
  double sum = 0;
  for (std::size_t i = at; i < decisions.size(); ++i) {
    const double delta = decisions[i].reward + gamma * decisions[i].next_value - decisions[i].value;
    sum += std::pow(gamma * lambda, static_cast<double>(i - at)) * delta;
    if (decisions[i].ends) break;
  }
  return sum;
}

TEST(PpoAdvantage, IsTheDiscountedSumUpToTheEndOfTheEpisode) {
  Rng rng(3, "decisions");
  std::vector<PpoDecision> decisions;
  for (int i = 0; i < 40; ++i)
    decisions.push_back({rng.Normal(), rng.Normal(), rng.Normal(), i % 13 == 12 || i == 39});
  const auto found = internal::AdvantagesOf(decisions, 0.97, 0.9);
  for (std::size_t i = 0; i < decisions.size(); ++i)
    EXPECT_NEAR(found[i], AdvantageBySum(decisions, i, 0.97, 0.9), 1e-12) << i;
}

// With lambda 1 and no value it is the return itself, a geometric series.
TEST(PpoAdvantage, OfConstantRewardsIsAGeometricSeries) {
  std::vector<PpoDecision> decisions(20, {.reward = 2});
  decisions.back().ends = true;
  const auto found = internal::AdvantagesOf(decisions, 0.9, 1);
  EXPECT_NEAR(found[0], 2 * (1 - std::pow(0.9, 20)) / (1 - 0.9), 1e-12);
}

// ---- the loss -----------------------------------------------------------------------------------

constexpr int kSeen = 4;
constexpr int kDone = 2;

PpoNetworks SmallNetworks() {
  PpoNetworks networks{{kSeen, 6, kDone}, {kSeen, 6, 1}};
  networks.actor = Drawn(MlpLayout(networks.actor_shape).size(), 0.5, "actor");
  networks.critic = Drawn(MlpLayout(networks.critic_shape).size(), 0.5, "critic");
  networks.log_deviation = {-0.4F, 0.2F};
  return networks;
}

PpoBatch SmallBatch(std::size_t rows) {
  PpoBatch batch;
  batch.observations = Drawn(rows * kSeen, 1, "observations");
  batch.actions = Drawn(rows * kDone, 1, "actions");
  batch.log_probabilities = Drawn(rows, 0.5, "probabilities");
  for (float& p : batch.log_probabilities) p -= 2.5F;
  batch.values = Drawn(rows, 1, "values");
  batch.advantages = Drawn(rows, 1, "advantages");
  batch.returns = Drawn(rows, 1, "returns");
  return batch;
}

std::vector<float> RowOf(const std::vector<float>& values, std::size_t row, int columns) {
  const auto first = values.begin() + static_cast<std::ptrdiff_t>(row) * columns;
  return {first, first + columns};
}

// The paper's formulas in double precision, a row at a time.
PpoLoss ReferenceLoss(const PpoNetworks& networks, const PpoBatch& batch, const PpoConfig& config) {
  PpoLoss loss;
  const auto rows = static_cast<double>(batch.size());
  for (std::size_t row = 0; row < batch.size(); ++row) {
    const auto seen = RowOf(batch.observations, row, kSeen);
    const auto mean = ReferenceMlp(networks.actor_shape, networks.actor, seen);
    double log_p = 0;
    for (std::size_t i = 0; i < kDone; ++i) {
      const double s = std::exp(double{networks.log_deviation[i]});
      const double a = batch.actions[row * kDone + i];
      log_p += -(a - mean[i]) * (a - mean[i]) / (2 * s * s) -
               std::log(s * std::sqrt(2 * std::numbers::pi));
    }
    const double log_ratio = log_p - batch.log_probabilities[row];
    const double ratio = std::exp(log_ratio);
    const double advantage = batch.advantages[row];
    const double clipped = std::clamp(ratio, 1 - config.clip, 1 + config.clip);
    loss.policy -= std::min(ratio * advantage, clipped * advantage) / rows;
    loss.kl += (ratio - 1 - log_ratio) / rows;
    loss.clipped += (std::abs(ratio - 1) > config.clip ? 1 : 0) / rows;
    const double value = ReferenceMlp(networks.critic_shape, networks.critic, seen)[0];
    const double before = batch.values[row];
    const double target = batch.returns[row];
    const double near = before + std::clamp(value - before, -config.value_clip, config.value_clip);
    const double error = (value - target) * (value - target);
    const double other = (near - target) * (near - target);
    loss.value += (config.value_clip > 0 ? std::max(error, other) : error) / 2 / rows;
  }
  for (const float s : networks.log_deviation)
    loss.entropy += double{s} + 0.5 * std::log(2 * std::numbers::pi * std::numbers::e);
  return loss;
}

double ObjectiveOf(const PpoLoss& loss, const PpoConfig& config) {
  return loss.policy + config.value * loss.value - config.entropy * loss.entropy;
}

// Without and with a clip of the value.
std::vector<PpoConfig> BothClips() {
  return {{.value_clip = 0, .entropy = 0.03, .value = 0.7},
          {.value_clip = 0.3, .entropy = 0.03, .value = 0.7}};
}

TEST(PpoLoss, IsThatOfThePapersFormulas) {
  const PpoNetworks networks = SmallNetworks();
  const PpoBatch batch = SmallBatch(24);
  for (const PpoConfig& config : BothClips()) {
    const PpoLoss expected = ReferenceLoss(networks, batch, config);
    const PpoLoss found = internal::PpoLossOf(networks, batch, config);
    EXPECT_NEAR(found.policy, expected.policy, 1e-4);
    EXPECT_NEAR(found.value, expected.value, 1e-5);
    EXPECT_NEAR(found.entropy, expected.entropy, 1e-5);
    EXPECT_NEAR(found.kl, expected.kl, 1e-4);
    EXPECT_NEAR(found.clipped, expected.clipped, 1e-6);
    EXPECT_GT(expected.clipped, 0.2);  // else nothing would be shown
    EXPECT_LT(expected.clipped, 0.99);
  }
}

// The slope of the objective along one parameter.
double SlopeAlong(std::vector<float> PpoNetworks::*part, std::size_t at, const PpoConfig& config) {
  constexpr float kStep = 1.0F / 4096;
  const PpoBatch batch = SmallBatch(24);
  PpoNetworks up = SmallNetworks();
  PpoNetworks down = up;
  (up.*part)[at] += kStep;
  (down.*part)[at] -= kStep;
  const double width = double{(up.*part)[at]} - double{(down.*part)[at]};
  return (ObjectiveOf(ReferenceLoss(up, batch, config), config) -
          ObjectiveOf(ReferenceLoss(down, batch, config), config)) /
         width;
}

TEST(PpoLoss, HasTheGradientOfFiniteDifferences) {
  const PpoNetworks networks = SmallNetworks();
  for (const PpoConfig& config : BothClips()) {
    const PpoLoss found = internal::PpoLossOf(networks, SmallBatch(24), config);
    std::size_t at = 0;
    for (std::vector<float> PpoNetworks::*part :
         {&PpoNetworks::actor, &PpoNetworks::log_deviation, &PpoNetworks::critic}) {
      for (std::size_t i = 0; i < (networks.*part).size(); ++i, ++at) {
        const double slope = SlopeAlong(part, i, config);
        EXPECT_NEAR(found.gradient[at], slope, 2e-3 * std::max(1.0, std::abs(slope))) << at;
      }
    }
    EXPECT_EQ(at, found.gradient.size());
  }
}

// ---- learning -----------------------------------------------------------------------------------

// A point on a line is to be led to 0: the best that can be done is -x, and nothing else earns as
// much.
class Line : public PpoStepper {
 public:
  std::vector<float> Reset(std::uint64_t episode) override {
    x_ = Rng(5, "line/" + std::to_string(episode)).Uniform(-1, 1);
    steps_ = 0;
    return {static_cast<float>(x_)};
  }
  PpoStep Step(std::span<const float> action) override {
    x_ += std::clamp(double{action[0]}, -0.5, 0.5);
    ++steps_;
    return {.observation = {static_cast<float>(x_)},
            .reward = -std::abs(x_),
            .truncated = steps_ == 8,
            .success = std::abs(x_) < 0.15};
  }

 private:
  double x_ = 0;
  int steps_ = 0;
};

const PpoTask kLine{1, 1, [] { return std::make_unique<Line>(); }};

PpoConfig LineConfig() {
  return {.decisions = 30000,
          .steppers = 16,
          .steps = 64,
          .learning_rate = 3e-3,
          .begin_deviation = 0.5,
          .hidden = 16};
}

PpoState TrainLine(const PpoConfig& config, int threads = 1) {
  return TrainPpo(kLine, config, InitialPpoState(kLine, config), {.threads = threads});
}

void ExpectSame(const PpoState& a, const PpoState& b) {
  EXPECT_EQ(a.networks.actor, b.networks.actor);
  EXPECT_EQ(a.networks.log_deviation, b.networks.log_deviation);
  EXPECT_EQ(a.networks.critic, b.networks.critic);
  EXPECT_EQ(a.first_moment, b.first_moment);
  EXPECT_EQ(a.second_moment, b.second_moment);
  EXPECT_EQ(a.gradient_steps, b.gradient_steps);
  ASSERT_EQ(a.updates.size(), b.updates.size());
  for (std::size_t i = 0; i < a.updates.size(); ++i)
    for (const PpoColumn& column : PpoColumns())
      EXPECT_EQ(a.updates[i].*column.value, b.updates[i].*column.value) << column.name;
}

TEST(Ppo, LearnsToLeadAPointToItsGoal) {
  const PpoState state = TrainLine(LineConfig());
  EXPECT_LT(state.updates.front().success, 0.5);
  EXPECT_GT(state.updates.back().success, 0.7);
  const Mlp actor(state.networks.actor_shape, state.networks.actor);
  for (const float x : {-0.4F, -0.2F, 0.0F, 0.2F, 0.4F})
    EXPECT_NEAR(actor(std::vector{x})[0], -x, 0.12) << x;
}

TEST(Ppo, GivesTheSameBytesForAnyNumberOfThreads) {
  PpoConfig config = LineConfig();
  config.decisions = 4096;
  ExpectSame(TrainLine(config, 1), TrainLine(config, 2));
}

TEST(Ppo, GoesOnAsIfItHadNeverStopped) {
  PpoConfig config = LineConfig();
  config.decisions = 5000;
  ASSERT_EQ(PpoUpdatesOf(config), 5U);
  const PpoState whole = TrainLine(config);
  PpoState half;
  PpoHooks hooks{.threads = 1};
  hooks.on_update = [&](const PpoState& state) { half = state; };
  hooks.stop = [&] { return half.updates.size() == 2; };
  ExpectSame(TrainPpo(kLine, config, InitialPpoState(kLine, config), hooks), half);
  ExpectSame(TrainPpo(kLine, config, half, {.threads = 2}), whole);
}

// Ends of both kinds, and an observation that no network should read.
class Odd : public Line {
 public:
  PpoStep Step(std::span<const float> action) override {
    PpoStep step = Line::Step(action);
    step.reward = std::nan("");
    return step;
  }
};

TEST(Ppo, EndsWhereARewardIsNoNumber) {
  const PpoTask task{1, 1, [] { return std::make_unique<Odd>(); }};
  const PpoConfig config = LineConfig();
  try {
    TrainPpo(task, config, InitialPpoState(task, config), {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kIncomplete);
  }
}

TEST(Ppo, RefusesSettingsOutOfRange) {
  PpoConfig config;
  config.clip = 0;
  try {
    InitialPpoState(kLine, config);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidConfig);
    EXPECT_NE(std::string(error.what()).find("config.clip"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace doorforge
