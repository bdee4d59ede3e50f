// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/trajectory_networks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <utility>

#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/networks/handle_points.h"

namespace doorforge {
namespace {

constexpr float kFineUnit = 0.05F;  // [m]
constexpr float kMostFine = 3;
constexpr float kCoarseUnit = 0.5F;  // [m]
constexpr std::array kDoorParts = {PointLabel::kHandle, PointLabel::kBody, PointLabel::kFrame};
static_assert(kDoorPoint == 6 + static_cast<int>(kDoorParts.size()));
constexpr std::size_t kBest = 5;

PointNetShape WithNumbers(const TrajectoryShape& shape, int own, int outputs) {
  return {.point = kDoorPoint,
          .point_hidden = shape.point_hidden,
          .point_features = shape.point_features,
          .cloud_hidden = shape.cloud_hidden,
          .cloud_features = shape.cloud_features,
          .own = own,
          .hidden = shape.hidden,
          .last_hidden = shape.last_hidden,
          .outputs = outputs};
}

// Farthest points first: the beginning of a sample is a sample.
void AppendBeginning(const LabelledCloud& cloud, int count, DoorSight& sight) {
  const auto points = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < points; ++i) {
    const std::size_t from = i % cloud.label.size();
    for (std::size_t k = 0; k < 3; ++k) sight.xyz.push_back(cloud.xyz[3 * from + k]);
    sight.label.push_back(cloud.label[from]);
  }
}

float Sigmoid(float logit) { return 1 / (1 + std::exp(-logit)); }

std::vector<float> PointsOf(const DoorSight& sight, const TrajectoryTarget& target) {
  std::vector<float> points;
  points.reserve(sight.label.size() * kDoorPoint);
  AppendDoorPoints(sight, target.contact_m, points);
  return points;
}

}  // namespace

void CheckTrajectoryLook(const TrajectoryLook& look, const std::string& path) {
  RequireRange(path, "near_points", look.near_points, 1, 4096);
  RequireRange(path, "far_points", look.far_points, 1, 4096);
  RequireRange(path, "near_m", look.near_m, 0.001, 10);
  RequireRange(path, "finer", look.finer, 1, 8);
}

void CheckTrajectoryShape(const TrajectoryShape& shape, const std::string& path) {
  RequireRange(path, "waypoints", shape.waypoints, 1, 100);
  RequireRange(path, "latent", shape.latent, 1, 4096);
  RequireRange(path, "point_hidden", shape.point_hidden, 1, 256);
  RequireRange(path, "point_features", shape.point_features, 32, 4096);
  RequireRange(path, "cloud_hidden", shape.cloud_hidden, 1, 4096);
  RequireRange(path, "cloud_features", shape.cloud_features, 1, 4096);
  RequireRange(path, "hidden", shape.hidden, 1, 4096);
  RequireRange(path, "last_hidden", shape.last_hidden, 1, 4096);
  Require(shape.point_features % 32 == 0, ErrorCode::kInvalidConfig,
          path + ".point_features: " + std::to_string(shape.point_features) +
              ", expected a multiple of 32");
}

std::optional<DoorSight> DoorSightOf(const GraspObservation& seen, const TrajectoryLook& look) {
  const LabelledCloud& visible = seen.visible;
  Require(visible.xyz.size() == 3 * visible.label.size(), ErrorCode::kInvalidArgument,
          "trajectory: the cloud has " + std::to_string(visible.xyz.size() / 3) + " points and " +
              std::to_string(visible.label.size()) + " labels");
  const std::vector<std::size_t> handle = internal::HandlePointsOf(visible.label);
  if (handle.empty()) return std::nullopt;
  const float* at = visible.xyz.data() + 3 * internal::MiddlePoint(visible.xyz, handle);
  const Eigen::Vector3d middle = Eigen::Vector3f(at[0], at[1], at[2]).cast<double>();
  DoorSight sight;
  AppendBeginning(seen.sample(middle, look.near_m), look.near_points, sight);
  AppendBeginning(seen.sample(middle, 0), look.far_points, sight);
  return sight;
}

void AppendDoorPoints(const DoorSight& sight, const Eigen::Vector3f& contact_m,
                      std::vector<float>& numbers) {
  for (std::size_t i = 0; i < sight.label.size(); ++i) {
    const Eigen::Vector3f from =
        Eigen::Vector3f(sight.xyz[3 * i], sight.xyz[3 * i + 1], sight.xyz[3 * i + 2]) - contact_m;
    for (const float x : from) numbers.push_back(std::clamp(x / kFineUnit, -kMostFine, kMostFine));
    for (const float x : from) numbers.push_back(x / kCoarseUnit);
    for (const PointLabel part : kDoorParts)
      numbers.push_back(sight.label[i] == static_cast<std::uint8_t>(part) ? 1.0F : 0.0F);
  }
}

void AppendTarget(const TrajectoryTarget& target, std::vector<float>& numbers) {
  for (const float x : target.contact_m) numbers.push_back(x);
  numbers.push_back(target.opening_rad);
}

PointNetShape ProposerShape(const TrajectoryShape& shape) {
  return WithNumbers(shape, kTargetNumbers + shape.latent, TrajectoryNumbers(shape.waypoints));
}

PointNetShape CriticShape(const TrajectoryShape& shape) {
  return WithNumbers(shape, kTargetNumbers + TrajectoryNumbers(shape.waypoints), 1);
}

PointNetShape AffordanceShape(const TrajectoryShape& shape) {
  return WithNumbers(shape, kTargetNumbers, 1);
}

ParameterLayout PosteriorLayout(const TrajectoryShape& shape) {
  ParameterLayout layout;
  layout.Add("posterior.0",
             shape.cloud_features + kTargetNumbers + TrajectoryNumbers(shape.waypoints),
             shape.hidden);
  layout.Add("posterior.1", shape.hidden, shape.last_hidden);
  layout.Add("posterior.2", shape.last_hidden, 2 * shape.latent);
  return layout;
}

TrajectoryNetworks InitialTrajectoryNetworks(const TrajectoryShape& shape, std::uint64_t seed) {
  return {shape, PointNetInitialisation(ProposerShape(shape), seed, "proposer."),
          HeInitialisation(PosteriorLayout(shape), seed, ""),
          PointNetInitialisation(CriticShape(shape), seed, "critic."),
          PointNetInitialisation(AffordanceShape(shape), seed, "affordance.")};
}

TrajectoryRater::TrajectoryRater(const TrajectoryNetworks& networks)
    : shape_(networks.shape),
      proposer_(ProposerShape(shape_), networks.proposer),
      critic_(CriticShape(shape_), networks.critic),
      affordance_(AffordanceShape(shape_), networks.affordance) {}

float TrajectoryRater::Affordance(const DoorSight& sight, const TrajectoryTarget& target) const {
  std::vector<float> own;
  AppendTarget(target, own);
  return Sigmoid(affordance_(PointsOf(sight, target), own)[0]);
}

TrajectoryRater::Proposals TrajectoryRater::Propose(const DoorSight& sight,
                                                    const TrajectoryTarget& target, int count,
                                                    Rng& rng) const {
  const std::vector<float> points = PointsOf(sight, target);
  std::vector<float> own;
  for (int i = 0; i < count; ++i) {
    AppendTarget(target, own);
    for (int k = 0; k < shape_.latent; ++k) own.push_back(static_cast<float>(rng.Normal()));
  }
  const std::vector<float> said = proposer_.Outputs(proposer_.CloudFeatures(points), own);
  own.clear();
  Proposals proposals;
  const auto each = static_cast<std::ptrdiff_t>(proposer_.shape().outputs);
  for (int i = 0; i < count; ++i) {
    const auto first = said.begin() + i * each;
    // rotations as they will be carried out, and as the critic has learned them
    proposals.numbers.push_back(
        ToNumbers(TrajectoryFromNumbers(std::vector<float>(first, first + each))));
    AppendTarget(target, own);
    own.insert(own.end(), proposals.numbers.back().begin(), proposals.numbers.back().end());
  }
  proposals.probability = critic_.Outputs(critic_.CloudFeatures(points), own);
  for (float& rating : proposals.probability) rating = Sigmoid(rating);
  return proposals;
}

float MeanOfBest(std::vector<float> probability) {
  const std::size_t count = std::min(kBest, probability.size());
  std::ranges::sort(probability, std::greater{});
  return std::accumulate(probability.begin(),
                         probability.begin() + static_cast<std::ptrdiff_t>(count), 0.0F) /
         static_cast<float>(count);
}

}  // namespace doorforge
