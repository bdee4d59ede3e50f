// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "../../train/learn/src/head_networks.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/rng.h"
#include "doorforge/learn/point_encoder.h"

#include "../../train/learn/src/network_batch.h"
#include "synthetic_samples.h"

namespace doorforge {
namespace {

using internal::HeadBatch;

struct Fixture {
  testing::SyntheticSamples made = testing::MakeSyntheticSamples(5, 6);
  StageNetworks networks = InitialNetworks(MeasureNormalisation(made.samples), false, 1);
  HeadBatch batch;
  TrainConfig config;

  Fixture() {
    std::vector<std::size_t> indices(made.samples.size());
    std::iota(indices.begin(), indices.end(), std::size_t{0});
    batch = internal::MakeHeadBatch(made.samples, indices, networks.normalisation);
    Rng rng(1, "test/heads");
    for (std::size_t i = 0; i < indices.size() * kFeatureSize; ++i)
      batch.features.push_back(static_cast<float>(rng.Normal()));
    for (std::size_t i = 0; i < indices.size() * kLatentSize; ++i)
      batch.noise.push_back(static_cast<float>(rng.Normal()));
  }
};

double Norm(std::span<const float> values) {
  return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0));
}

// Slope of `value` along `direction` through `at`, by a central difference.
double Slope(std::vector<float>& at, std::size_t offset, std::span<const float> direction,
             const std::function<double()>& value) {
  constexpr double kStep = 1e-3;
  const std::vector<float> saved = at;
  const auto move = [&](double step) {
    for (std::size_t i = 0; i < direction.size(); ++i)
      at[offset + i] = saved[offset + i] + static_cast<float>(step * direction[i]);
    return value();
  };
  const double slope = (move(kStep) - move(-kStep)) / (2 * kStep);
  at = saved;
  return slope;
}

void ExpectGradientOfLayers(const ParameterLayout& layout, std::vector<float>& parameters,
                            const std::vector<float>& gradient,
                            const std::function<double()>& value) {
  for (const DenseLayer& layer : layout.layers()) {
    if (layer.name.rfind("encoder.", 0) == 0) continue;
    std::vector<float> direction(gradient.begin() + static_cast<std::ptrdiff_t>(layer.offset),
                                 gradient.begin() + static_cast<std::ptrdiff_t>(layer.end()));
    const double norm = Norm(direction);
    ASSERT_GT(norm, 0) << layer.name;
    for (float& d : direction) d = static_cast<float>(d / norm);
    EXPECT_NEAR(Slope(parameters, layer.offset, direction, value) / norm, 1, 0.03) << layer.name;
  }
}

TEST(HeadNetworks, TheActorsGradientIsThatOfFiniteDifferences) {
  Fixture f;
  std::vector<float> gradient(ActorLayout().size());
  const auto result = ActorObjective(f.networks, f.batch, f.config, gradient);
  const auto value = [&] { return ActorObjective(f.networks, f.batch, f.config, {}).objective; };
  EXPECT_EQ(result.objective, value());
  ExpectGradientOfLayers(ActorLayout(), f.networks.actor, gradient, value);
  std::vector<float> direction = result.feature_gradient;
  const double norm = Norm(direction);
  for (float& d : direction) d = static_cast<float>(d / norm);
  EXPECT_NEAR(Slope(f.batch.features, 0, direction, value) / norm, 1, 0.03);
}

TEST(HeadNetworks, TheCriticsGradientIsThatOfFiniteDifferences) {
  Fixture f;
  std::vector<float> gradient(CriticLayout().size());
  const auto result = CriticObjective(f.networks, f.batch, gradient);
  const auto value = [&] { return CriticObjective(f.networks, f.batch, {}).objective; };
  EXPECT_EQ(result.objective, value());
  ExpectGradientOfLayers(CriticLayout(), f.networks.critic, gradient, value);
}

// With a decoder of zeros the prediction is the training set's mean action.
TEST(HeadNetworks, LossesOfAKnownPredictionAreTheClosedForm) {
  Fixture f;
  const DenseLayer& last = ActorLayout().layers().back();
  ASSERT_EQ(last.name, "decoder.2");
  std::fill(f.networks.actor.begin() + static_cast<std::ptrdiff_t>(last.offset),
            f.networks.actor.begin() + static_cast<std::ptrdiff_t>(last.end()), 0.0F);
  const ActionVector mean = f.networks.normalisation.action.mean;
  double position = 0;
  double angle = 0;
  for (const TrainingSample& sample : f.made.samples) {
    for (std::size_t i = 0; i < 3; ++i) position += std::abs(sample.action[i] - mean[i]);
    angle += RotationVector(FromVector(mean).world_from_hand_rotation.transpose() *
                            FromVector(sample.action).world_from_hand_rotation)
                 .norm();
  }
  const auto count = static_cast<double>(f.made.samples.size());
  const auto result = ActorObjective(f.networks, f.batch, f.config, {});
  EXPECT_NEAR(result.losses.position_m, position / (3 * count), 1e-6);
  EXPECT_NEAR(result.losses.rotation_rad, angle / count, 1e-4);
}

TEST(HeadNetworks, RotationGradientsStayFiniteAtTheTargetAndOppositeIt) {
  Fixture f;
  const DenseLayer& last = ActorLayout().layers().back();
  for (const double turn : {0.0, std::numbers::pi}) {
    std::fill(f.networks.actor.begin() + static_cast<std::ptrdiff_t>(last.offset),
              f.networks.actor.begin() + static_cast<std::ptrdiff_t>(last.end()), 0.0F);
    Action mean;
    mean.world_from_hand_rotation = RotationAbout(Eigen::Vector3d::UnitZ(), turn).linear();
    f.networks.normalisation.action.mean = ToVector(mean);
    std::fill(f.batch.actions.begin(), f.batch.actions.end(), 0.0F);  // the target is the mean
    if (turn != 0) {
      for (std::size_t i = 0; i < f.batch.actions.size(); i += 9) {
        // rows 1 and 2 of the mean, negated: the target is turned by 180 degrees about z
        for (std::size_t j = 3; j < 9; ++j)
          f.batch.actions[i + j] = -2 * f.networks.normalisation.action.mean[j] /
                                   f.networks.normalisation.action.deviation[j];
      }
    }
    std::vector<float> gradient(ActorLayout().size());
    const auto result = ActorObjective(f.networks, f.batch, f.config, gradient);
    EXPECT_NEAR(result.losses.rotation_rad, turn, 0.03);
    for (const float g : gradient) ASSERT_TRUE(std::isfinite(g));
  }
}

}  // namespace
}  // namespace doorforge
