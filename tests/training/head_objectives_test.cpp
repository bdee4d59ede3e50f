// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "head_objectives.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/rng.h"
#include "doorforge/networks/heads.h"
#include "doorforge/networks/point_encoder.h"

#include "network_batch.h"
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
    batch = internal::MakeHeadBatch(made.samples, networks.normalisation);
    Rng rng(1, "test/heads");
    for (std::size_t i = 0; i < made.samples.size() * kFeatureSize; ++i)
      batch.features.push_back(static_cast<float>(rng.Normal()));
    for (std::size_t i = 0; i < made.samples.size() * kLatentSize; ++i)
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
                            const std::function<double()>& value,
                            const std::string& not_read = "encoder.") {
  for (const DenseLayer& layer : layout.layers()) {
    if (layer.name.starts_with("encoder.")) continue;
    if (layer.name.starts_with(not_read)) {
      EXPECT_EQ(Norm(std::span(gradient).subspan(layer.offset, layer.end() - layer.offset)), 0);
      continue;
    }
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

// ---- grasp --------------------------------------------------------------------------------------

constexpr std::size_t kNear = 5;

struct GraspFixture : Fixture {
  GraspFixture() {
    Rng rng(2, "test/near");
    for (std::size_t i = 0; i < made.samples.size() * kNear * 3; ++i)
      batch.near.push_back(static_cast<float>(rng.Normal()));
    networks = InitialNetworks(MeasureNormalisation(made.samples), false, 1, NetworkFamily::kGrasp);
    for (std::size_t i = 0; i < batch.actions.size(); i += 9)
      batch.points.insert(batch.points.end(), batch.actions.begin() + static_cast<long>(i),
                          batch.actions.begin() + static_cast<long>(i + 3));
  }
};

TEST(HeadNetworks, TheFindersGradientIsThatOfFiniteDifferencesAndItsValueTheWeightedCrossEntropy) {
  Fixture f;
  f.networks =
      InitialNetworks(MeasureNormalisation(f.made.samples), false, 1, NetworkFamily::kFind);
  const ParameterLayout& layout = ActorLayout(NetworkFamily::kFind);
  for (std::size_t i = 0; i < f.made.samples.size(); ++i) {
    f.batch.is_handle.push_back(i % 3 == 0 ? 1.0F : 0.0F);
    f.batch.weights.push_back(0.5F + static_cast<float>(i));
  }
  const internal::FinderNetwork network{layout, f.networks.actor, &StageLosses::place};
  std::vector<float> gradient(layout.size());
  const auto value = [&] { return FinderObjective(network, f.batch, {}).objective; };
  const auto result = FinderObjective(network, f.batch, gradient);
  EXPECT_EQ(result.objective, value());
  ExpectGradientOfLayers(layout, f.networks.actor, gradient, value);
  std::vector<float> direction = result.feature_gradient;
  const double norm = Norm(direction);
  for (float& d : direction) d = static_cast<float>(d / norm);
  EXPECT_NEAR(Slope(f.batch.features, 0, direction, value) / norm, 1, 0.03);
  // the kernels that run a finder compute the same logits
  const std::vector<float> logits = internal::FinderHead(layout, f.networks.actor).Score({f.batch});
  double sum = 0;
  double weights = 0;
  for (std::size_t i = 0; i < logits.size(); ++i) {
    const double p = 1 / (1 + std::exp(-static_cast<double>(logits[i])));
    sum -= f.batch.weights[i] * std::log(f.batch.is_handle[i] > 0 ? p : 1 - p);
    weights += f.batch.weights[i];
  }
  EXPECT_NEAR(sum / weights, result.objective, 1e-5);
  EXPECT_EQ(*result.losses.place, result.objective);
}

TEST(HeadNetworks, TheDiscriminatorsGradientIsThatOfFiniteDifferencesForBothLosses) {
  for (const auto& [loss, by_near_points] : {std::pair{ScoreLoss::kSquared, true},
                                             {ScoreLoss::kSquared, false},
                                             {ScoreLoss::kAbsolute, false}}) {
    GraspFixture f;
    f.config.score_loss = loss;
    if (!by_near_points) f.batch.near.clear();
    std::vector<float> gradient(CriticLayout(NetworkFamily::kGrasp).size());
    // angles of doors, not of single actions, so that the loss has something to differ in
    for (std::size_t i = 0; i < f.batch.angle_gains_rad.size(); ++i)
      f.batch.angle_gains_rad[i] = i % 2 ? 0.8F : 0.0F;
    f.networks.normalisation.angle_gain_rad.deviation = {0.4F};
    const auto value = [&] {
      return DiscriminatorObjective(f.networks, f.batch, f.config, {}).objective;
    };
    const auto result = DiscriminatorObjective(f.networks, f.batch, f.config, gradient);
    EXPECT_EQ(result.objective, value());
    ExpectGradientOfLayers(CriticLayout(NetworkFamily::kGrasp), f.networks.critic, gradient, value,
                           by_near_points ? "action." : "near.");
    if (by_near_points) {
      EXPECT_TRUE(result.feature_gradient.empty());
      continue;
    }
    std::vector<float> direction = result.feature_gradient;
    const double norm = Norm(direction);
    for (float& d : direction) d = static_cast<float>(d / norm);
    EXPECT_NEAR(Slope(f.batch.features, 0, direction, value) / norm, 1, 0.03);
  }
}

TEST(HeadNetworks, TheAffordancesGradientIsThatOfFiniteDifferences) {
  GraspFixture f;
  std::vector<float> gradient(ActorLayout(NetworkFamily::kGrasp).size());
  for (float& gain : f.batch.angle_gains_rad) gain += 0.5F;
  const auto value = [&] { return AffordanceObjective(f.networks, f.batch, {}).objective; };
  EXPECT_EQ(AffordanceObjective(f.networks, f.batch, gradient).objective, value());
  ExpectGradientOfLayers(ActorLayout(NetworkFamily::kGrasp), f.networks.actor, gradient, value);
}

// Written out with loops: what the paper's table says of D_grasp.
std::vector<double> DenseByHand(const ParameterLayout& layout, const std::vector<float>& weights,
                                const std::string& name, const std::vector<double>& x) {
  for (const DenseLayer& layer : layout.layers()) {
    if (layer.name != name) continue;
    EXPECT_EQ(static_cast<std::size_t>(layer.inputs), x.size()) << name;
    std::vector<double> y;
    for (int o = 0; o < layer.outputs; ++o) {
      double sum = weights[layer.bias_offset() + static_cast<std::size_t>(o)];
      for (int i = 0; i < layer.inputs; ++i)
        sum +=
            static_cast<double>(weights[layer.offset + static_cast<std::size_t>(o) * layer.inputs +
                                        static_cast<std::size_t>(i)]) *
            x[static_cast<std::size_t>(i)];
      y.push_back(sum);
    }
    return y;
  }
  ADD_FAILURE() << name;
  return {};
}

std::vector<double> BranchByHand(const std::vector<float>& weights, const std::string& name,
                                 std::vector<double> x) {
  for (const char* layer : {".0", ".1", ".2"}) {
    x = DenseByHand(CriticLayout(NetworkFamily::kGrasp), weights, name + layer, x);
    if (std::string(layer) == ".2") break;
    for (double& v : x) v = std::max(v, 0.0);
  }
  return x;
}

// Rows [begin, end) of a table with so many columns.
std::vector<double> Numbers(const std::vector<float>& table, std::size_t begin, std::size_t end,
                            std::size_t columns) {
  return {table.begin() + static_cast<long>(begin * columns),
          table.begin() + static_cast<long>(end * columns)};
}

void ExpectDiscriminatorByHand(const GraspFixture& f) {
  const ParameterLayout& layout = CriticLayout(NetworkFamily::kGrasp);
  const std::vector<float> scores = internal::DiscriminatorHead(f.networks).Score(f.batch);
  for (std::size_t n = 0; n < scores.size(); ++n) {
    const std::vector<double> x =
        BranchByHand(f.networks.critic, "action", Numbers(f.batch.actions, n, n + 1, 9));
    const bool by_near_points = !f.batch.near.empty();
    std::vector<double> near(128, 0.0);
    for (std::size_t p = kNear * n; p < kNear * (n + 1) && by_near_points; ++p) {
      const std::vector<double> each =
          BranchByHand(f.networks.critic, "near", Numbers(f.batch.near, p, p + 1, 3));
      for (std::size_t i = 0; i < near.size(); ++i) near[i] = std::max(near[i], each[i]);
    }
    std::vector<double> joined = Numbers(f.batch.features, n, n + 1, kFeatureSize);
    joined.insert(joined.end(), x.begin(), x.end());
    if (by_near_points) joined.assign(joined.size(), 0.0);
    joined.insert(joined.end(), near.begin(), near.end());
    std::vector<double> hidden = DenseByHand(layout, f.networks.critic, "score.0", joined);
    for (double& v : hidden) v = v > 0 ? v : 0.01 * v;
    const double score = DenseByHand(layout, f.networks.critic, "score.1", hidden)[0];
    const auto& normaliser = f.networks.normalisation.angle_gain_rad;
    EXPECT_NEAR(scores[n], score * normaliser.deviation[0] + normaliser.mean[0], 1e-5);
  }
}

TEST(HeadNetworks, TheDiscriminatorIsThePapersTableAndTheMaximumOverNearPoints) {
  GraspFixture f;
  ExpectDiscriminatorByHand(f);
  f.batch.near.clear();
  ExpectDiscriminatorByHand(f);
}

// The mean absolute error that training reports of scores, from those that a policy computes.
double MeanError(const std::vector<float>& scores, const HeadBatch& batch) {
  double sum = 0;
  for (std::size_t i = 0; i < scores.size(); ++i)
    sum += std::abs(static_cast<double>(scores[i]) - static_cast<double>(batch.angle_gains_rad[i]));
  return sum / static_cast<double>(scores.size());
}

const std::vector<InstructionSet> kInstructionSets = {
    InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512};

TEST(Heads, APolicyScoresAsTrainingDoesOnEveryInstructionSet) {
  Fixture motion;
  GraspFixture grasp;
  for (const InstructionSet set : kInstructionSets) {
    if (!IsSupported(set)) continue;
    const auto critic = internal::CriticHead(motion.networks, set).Score(motion.batch);
    EXPECT_NEAR(MeanError(critic, motion.batch),
                *CriticObjective(motion.networks, motion.batch, {}).losses.angle_gain_rad, 1e-6);
    const auto affordance = internal::AffordanceHead(grasp.networks, set).Score(grasp.batch);
    EXPECT_NEAR(MeanError(affordance, grasp.batch),
                *AffordanceObjective(grasp.networks, grasp.batch, {}).losses.affordance_rad, 1e-6);
    const auto near = internal::DiscriminatorHead(grasp.networks, set).Score(grasp.batch);
    EXPECT_NEAR(MeanError(near, grasp.batch),
                *DiscriminatorObjective(grasp.networks, grasp.batch, grasp.config, {})
                     .losses.angle_gain_rad,
                1e-6);
  }
}

TEST(Heads, APolicyDecodesAsTrainingDoesWithEitherKindOfBranches) {
  for (const bool linear : {false, true}) {
    Fixture f;
    f.networks = InitialNetworks(MeasureNormalisation(f.made.samples), linear, 1);
    const std::vector<float> zeros(f.made.samples.size() * kLatentSize);
    const auto decoded = internal::ActorHead(f.networks).Decode(f.batch, zeros);
    double error = 0;
    for (std::size_t i = 0; i < f.made.samples.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        error += std::abs(static_cast<double>(decoded[9 * i + k]) -
                          static_cast<double>(f.made.samples[i].action[k]));
    EXPECT_NEAR(error / static_cast<double>(3 * f.made.samples.size()),
                *ActorObjective(f.networks, f.batch, f.config, {}).losses.position_m, 1e-6);
  }
}

TEST(Heads, ASamplesResultDoesNotDependOnThoseBesideIt) {
  GraspFixture f;
  const internal::DiscriminatorHead head(f.networks);
  const std::vector<float> together = head.Score(f.batch);
  for (std::size_t i = 0; i < together.size(); ++i) {
    internal::HeadInputs one;
    one.size = 1;
    const auto begin = f.batch.near.begin() + static_cast<long>(3 * kNear * i);
    one.near.assign(begin, begin + static_cast<long>(3 * kNear));
    EXPECT_EQ(head.Score(one).front(), together[i]);
  }
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
  EXPECT_NEAR(*result.losses.position_m, position / (3 * count), 1e-6);
  EXPECT_NEAR(*result.losses.rotation_rad, angle / count, 1e-4);
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
    EXPECT_NEAR(*result.losses.rotation_rad, turn, 0.03);
    for (const float g : gradient) ASSERT_TRUE(std::isfinite(g));
  }
}

}  // namespace
}  // namespace doorforge
