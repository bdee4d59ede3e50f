// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/dagger.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"

#include "point_net_loss.h"

namespace doorforge {
namespace {

using internal::PointNetBatch;

std::vector<float> Noise(std::size_t count, double scale, const std::string& stream) {
  Rng rng(13, stream);
  std::vector<float> values(count);
  for (float& value : values) value = static_cast<float>(scale * rng.Normal());
  return values;
}

constexpr int kSeenPoints = 40;
constexpr int kTaught = 5;
const PointNetShape kStudent{.point = 7,
                             .point_hidden = 24,
                             .point_features = 64,
                             .cloud_hidden = 32,
                             .cloud_features = 16,
                             .own = 5,
                             .hidden = 24,
                             .last_hidden = 12,
                             .outputs = 3};

PointNetBatch SomeBatch() {
  return {kTaught, Noise(std::size_t{kTaught} * kSeenPoints * 7, 1, "points"),
          Noise(std::size_t{kTaught} * 5, 1, "own"), Noise(std::size_t{kTaught} * 3, 1, "taught")};
}

std::vector<float> SomeWeights() {
  std::vector<float> weights = PointNetInitialisation(kStudent, 3, "test.");
  const auto noise = Noise(weights.size(), 0.05, "weights");  // biases, too
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] += noise[i];
  return weights;
}

enum class After { kRelu, kElu, kNothing };

// One layer from the flat vector in double precision.
std::vector<double> ReferenceLayer(const DenseLayer& layer, const std::vector<double>& weights,
                                   const std::vector<double>& x, After after) {
  std::vector<double> y;
  for (int o = 0; o < layer.outputs; ++o) {
    double sum = weights[layer.bias_offset() + static_cast<std::size_t>(o)];
    for (int i = 0; i < layer.inputs; ++i)
      sum += weights[layer.offset + static_cast<std::size_t>(o * layer.inputs + i)] *
             x[static_cast<std::size_t>(i)];
    if (after == After::kRelu) sum = std::max(sum, 0.0);
    if (after == After::kElu && sum < 0) sum = std::exp(sum) - 1;
    y.push_back(sum);
  }
  return y;
}

// The network as its header describes it, a point at a time.
std::vector<double> ReferencePointNet(const std::vector<double>& weights, const float* points,
                                      const float* own) {
  const ParameterLayout layout = PointNetLayout(kStudent);
  const auto& layers = layout.layers();
  std::vector<double> best(64);
  for (int p = 0; p < kSeenPoints; ++p) {
    std::vector<double> x(points + 7 * p, points + 7 * p + 7);
    x = ReferenceLayer(layers[0], weights, x, After::kRelu);
    x = ReferenceLayer(layers[1], weights, x, After::kRelu);
    for (std::size_t i = 0; i < best.size(); ++i) best[i] = std::max(best[i], x[i]);
  }
  std::vector<double> x = ReferenceLayer(layers[2], weights, best, After::kRelu);
  x = ReferenceLayer(layers[3], weights, x, After::kRelu);
  x.insert(x.end(), own, own + 5);
  for (const std::size_t layer : {4U, 5U, 6U})
    x = ReferenceLayer(layers[layer], weights, x, After::kElu);
  return ReferenceLayer(layers[7], weights, x, After::kNothing);
}

double ReferenceDaggerLoss(const std::vector<double>& weights, const PointNetBatch& batch) {
  double sum = 0;
  for (std::size_t n = 0; n < kTaught; ++n) {
    const auto says = ReferencePointNet(weights, batch.points.data() + n * kSeenPoints * 7,
                                        batch.own.data() + n * 5);
    for (std::size_t i = 0; i < 3; ++i)
      sum += (says[i] - batch.targets[3 * n + i]) * (says[i] - batch.targets[3 * n + i]);
  }
  return sum;
}

// Our kernels, which act, and libtorch, which learns, against the definition.
TEST(PointNet, IsWhatItsHeaderSaysForKernelsAndLibtorch) {
  const PointNetBatch batch = SomeBatch();
  const std::vector<float> weights = SomeWeights();
  const PointNet network(kStudent, weights);
  const auto learns = internal::PointNetOutputsOf(kStudent, weights, batch);
  const std::vector<double> exact(weights.begin(), weights.end());
  for (std::size_t n = 0; n < kTaught; ++n) {
    const auto points = std::span(batch.points).subspan(n * kSeenPoints * 7, kSeenPoints * 7);
    const auto own = std::span(batch.own).subspan(n * 5, 5);
    const auto acts = network(points, own);
    const auto expected = ReferencePointNet(exact, points.data(), own.data());
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(acts[i], expected[i], 1e-5);
      EXPECT_NEAR(acts[i], learns[3 * n + i], 1e-5);
    }
  }
}

// At the size that it has in use.
TEST(PointNet, AgreesWithLibtorchAtFullSize) {
  const PointNetShape shape = SightShape({});
  const auto weights = PointNetInitialisation(shape, 5, "test.");
  PointNetBatch batch{3,
                      Noise(std::size_t{3} * 512 * kSightPoint, 1, "p"),
                      Noise(std::size_t{3} * kSightOwn, 1, "o"),
                      {}};
  const auto learns = internal::PointNetOutputsOf(shape, weights, batch);
  const PointNet network(shape, weights);
  for (std::size_t n = 0; n < 3; ++n) {
    const auto acts = network(
        std::span(batch.points).subspan(n * 512 * kSightPoint, std::size_t{512} * kSightPoint),
        std::span(batch.own).subspan(n * kSightOwn, kSightOwn));
    for (std::size_t i = 0; i < kHandActions; ++i)
      EXPECT_NEAR(acts[i], learns[n * kHandActions + i], 1e-5);
  }
}

TEST(PointNet, RefusesOtherSizes) {
  const std::vector<float> weights = SomeWeights();
  EXPECT_THROW(PointNet(kStudent, std::span(weights).first(10)), Error);
  const PointNet network(kStudent, weights);
  EXPECT_THROW(network({}, std::vector<float>(5)), Error);
  EXPECT_THROW(network(std::vector<float>(8), std::vector<float>(5)), Error);
  EXPECT_THROW(network(std::vector<float>(7), std::vector<float>(4)), Error);
}

// Central differences of the definition, some weights and biases of each layer.
TEST(DaggerLoss, HasTheGradientOfItsDefinition) {
  const PointNetBatch batch = SomeBatch();
  const std::vector<float> weights = SomeWeights();
  const std::vector<double> exact(weights.begin(), weights.end());
  std::vector<float> gradient(weights.size(), 1);  // is added to
  const double loss = internal::PointNetLossOf({kStudent}, weights, batch, 0.5, gradient);
  EXPECT_NEAR(loss, ReferenceDaggerLoss(exact, batch), 1e-4 * loss);
  EXPECT_NEAR(internal::PointNetLossOf({kStudent}, weights, batch, 0.5, {}), loss, 1e-5 * loss);
  const ParameterLayout layout = PointNetLayout(kStudent);
  for (const DenseLayer& layer : layout.layers()) {
    const std::size_t step = std::max<std::size_t>((layer.end() - layer.offset) / 23, 1);
    for (std::size_t at = layer.offset; at < layer.end(); at += step) {
      const auto moved = [&](double by) {
        std::vector<double> other = exact;
        other[at] += by;
        return ReferenceDaggerLoss(other, batch);
      };
      const double slope = 0.5 * (moved(1e-6) - moved(-1e-6)) / 2e-6;
      EXPECT_NEAR(gradient[at] - 1, slope, 1e-3 * std::abs(slope) + 1e-4) << layer.name << at;
    }
  }
}

// ---- the rounds ---------------------------------------------------------------------------------

constexpr int kToyPoints = 16;
constexpr int kToyEpisode = 12;

// A tool on a line is to come to the handle, which it sees: the teacher moves it by how far it is,
// one step at most.
class ToyStepper : public DaggerStepper {
 public:
  void Reset(std::uint64_t episode) override {
    rng_ = Rng(5, "toy/" + std::to_string(episode));
    at_ = rng_.Uniform(-1, 1);
    goal_ = rng_.Uniform(-1, 1);
    left_ = kToyEpisode;
  }
  HandSight See() override {
    HandSight sight;
    for (int i = 0; i < kToyPoints - 4; ++i) {  // the learner fills up what is missing
      sight.xyz.insert(sight.xyz.end(), {static_cast<float>(goal_ - at_), 0.1F * i, 0});
      sight.label.push_back(static_cast<std::uint8_t>(PointLabel::kHandle));
    }
    return sight;
  }
  std::vector<float> Teach() override {
    std::vector<float> action(kHandActions);
    action[0] = static_cast<float>(std::clamp(2 * (goal_ - at_), -1.0, 1.0));
    return action;
  }
  DaggerStep Step(std::span<const float> action) override {
    at_ += 0.3 * std::clamp(double{action[0]}, -1.0, 1.0);
    return {.over = --left_ == 0, .success = std::abs(goal_ - at_) < 0.1};
  }

 private:
  Rng rng_{5, "toy"};
  double at_ = 0;
  double goal_ = 0;
  int left_ = 0;
};

const DaggerTask kToy{kToyPoints, [] { return std::make_unique<ToyStepper>(); }};

DaggerConfig ToyConfig() {
  DaggerConfig config;
  config.rounds = 3;
  config.episodes = 6;
  config.cloning_minibatches = 60;
  config.minibatches = 30;
  config.minibatch = 40;  // not a multiple of what a thread takes
  config.point_hidden = 16;
  config.point_features = 32;
  config.cloud_hidden = config.cloud_features = 16;
  config.hidden = config.last_hidden = 16;
  return config;
}

void ExpectSameStates(const DaggerState& a, const DaggerState& b) {
  EXPECT_EQ(a.network, b.network);
  EXPECT_EQ(a.second_moment, b.second_moment);
  EXPECT_EQ(a.gradient_steps, b.gradient_steps);
  ASSERT_EQ(a.rounds.size(), b.rounds.size());
  for (std::size_t i = 0; i < a.rounds.size(); ++i)
    for (const DaggerColumn& column : DaggerColumns())
      EXPECT_EQ(a.rounds[i].*column.value, b.rounds[i].*column.value) << column.name;
}

TEST(Dagger, LearnsWhatTheTeacherDoes) {
  DaggerConfig config = ToyConfig();
  config.cloning_minibatches = 200;
  config.minibatches = 100;
  const DaggerState state =
      TrainDagger(kToy, config, InitialDaggerState(config), {}, {.threads = 1});
  ASSERT_EQ(state.rounds.size(), 3U);
  EXPECT_EQ(state.rounds[0].teacher, 1);  // cloning
  EXPECT_EQ(state.rounds[0].decisions, 6 * kToyEpisode);
  EXPECT_EQ(state.rounds[2].decisions, 3 * 6 * kToyEpisode);
  EXPECT_NEAR(state.rounds[2].teacher, 0.25, 0.2);
  EXPECT_LT(state.rounds[2].error, 0.25 * state.rounds[0].error);
  EXPECT_EQ(state.rounds[2].success, 1);
  EXPECT_EQ(state.gradient_steps, 400U);
}

TEST(Dagger, IsTheSameForAnyNumberOfThreadsAndInParts) {
  const DaggerConfig config = ToyConfig();
  std::vector<DaggerState> states;
  DaggerSamples samples;
  DaggerHooks hooks{.threads = 1};
  hooks.on_round = [&](const DaggerState& state, const DaggerSamples& fresh) {
    states.push_back(state);
    if (states.size() < 3) samples.Append(fresh);
  };
  const DaggerState one = TrainDagger(kToy, config, InitialDaggerState(config), {}, hooks);
  const DaggerState two = TrainDagger(kToy, config, InitialDaggerState(config), {}, {.threads = 3});
  ExpectSameStates(one, two);
  const DaggerState rest = TrainDagger(kToy, config, states[1], samples, {.threads = 2});
  ExpectSameStates(one, rest);
}

// What is stopped in the middle of a round is as before the round.
TEST(Dagger, StopsWithTheLastRoundThatIsDone) {
  const DaggerConfig config = ToyConfig();
  for (const std::size_t calls : {3U, 20U, 80U}) {
    std::size_t called = 0;
    std::size_t written = 0;
    DaggerHooks hooks{.threads = 1};
    hooks.stop = [&] { return ++called > calls; };
    hooks.on_round = [&](const DaggerState&, const DaggerSamples&) { ++written; };
    const DaggerState state = TrainDagger(kToy, config, InitialDaggerState(config), {}, hooks);
    EXPECT_EQ(state.rounds.size(), written);
    EXPECT_EQ(written, 0U);
    ExpectSameStates(state, InitialDaggerState(config));
  }
}

TEST(DaggerSamples, KeepTheNewest) {
  DaggerSamples samples{.points = 2};
  for (int i = 0; i < 5; ++i) {
    HandSight sight{std::vector<float>(3, static_cast<float>(i)), {1}, {}};
    sight.own.fill(static_cast<float>(i));
    samples.Add(sight, std::vector<float>(kHandActions, static_cast<float>(i)));
  }
  EXPECT_EQ(samples.size(), 5U);
  samples.KeepLast(2);
  EXPECT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples.xyz, (std::vector<float>{3, 3, 3, 3, 3, 3, 4, 4, 4, 4, 4, 4}));
  EXPECT_EQ(samples.label.size(), 4U);
  EXPECT_EQ(samples.own.front(), 3);
  EXPECT_EQ(samples.taught.front(), 3);
}

TEST(DaggerConfig, IsChecked) {
  DaggerConfig config;
  config.point_features = 40;
  EXPECT_THROW(CheckDaggerConfig(config, "config.dagger"), Error);
  config = {};
  config.teacher_share = 1.5;
  EXPECT_THROW(InitialDaggerState(config), Error);
}

}  // namespace
}  // namespace doorforge
