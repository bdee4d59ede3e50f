// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/random_grasp.h"

#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "doorforge/core/error.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/rng.h"

namespace doorforge {
namespace {

Eigen::Vector3f PointOf(const LabelledCloud& cloud, std::size_t i) {
  return {cloud.xyz[3 * i], cloud.xyz[3 * i + 1], cloud.xyz[3 * i + 2]};
}

bool HasLabel(const LabelledCloud& cloud, std::size_t i, PointLabel label) {
  return cloud.label[i] == static_cast<std::uint8_t>(label);
}

// Indices of the points that a contact may be drawn from.
struct Candidates {
  std::vector<std::size_t> handle;
  std::vector<std::size_t> beside;
};

Candidates CandidatesIn(const LabelledCloud& cloud, double beside_m) {
  Candidates found;
  Eigen::AlignedBox3f box;
  for (std::size_t i = 0; i < cloud.label.size(); ++i) {
    if (!HasLabel(cloud, i, PointLabel::kHandle)) continue;
    found.handle.push_back(i);
    box.extend(PointOf(cloud, i));
  }
  if (found.handle.empty()) return found;
  for (std::size_t i = 0; i < cloud.label.size(); ++i) {
    const bool other =
        !HasLabel(cloud, i, PointLabel::kHandle) && !HasLabel(cloud, i, PointLabel::kRobot);
    if (other && box.exteriorDistance(PointOf(cloud, i)) <= static_cast<float>(beside_m))
      found.beside.push_back(i);
  }
  return found;
}

void RequireShare(double share, const char* name) {
  Require(share >= 0 && share <= 1, ErrorCode::kInvalidConfig,
          std::string("config.grasp.") + name + ": out of 0..1");
}

void RequireSpread(double spread, const char* name) {
  Require(spread >= 0 && spread < 10, ErrorCode::kInvalidConfig,
          std::string("config.grasp.") + name + ": out of 0..10");
}

// Near the handle's own grasp, or turned any way about the approach.
Eigen::Matrix3d Orientation(const RandomGraspConfig& config, const GraspObservation& observation,
                            Rng& rng) {
  const double half_turn = std::numbers::pi / 2;
  const bool near = rng.Uniform() < config.near_share;
  const double turn =
      near ? config.near_turn_rad * rng.Normal() : rng.Uniform(-half_turn, half_turn);
  const double about_x = config.tilt_rad * rng.Normal();
  const double about_y = config.tilt_rad * rng.Normal();
  return observation.privileged.world_from_tcp.linear() *
         RotationAbout(Eigen::Vector3d::UnitX(), about_x).linear() *
         RotationAbout(Eigen::Vector3d::UnitY(), about_y).linear() *
         RotationAbout(Eigen::Vector3d::UnitZ(), turn).linear() *
         observation.hand_from_tcp.linear().transpose();
}

}  // namespace

void CheckRandomGrasp(const RandomGraspConfig& config) {
  RequireShare(config.near_share, "near_share");
  RequireShare(config.beside_share, "beside_share");
  RequireSpread(config.near_turn_rad, "near_turn_rad");
  RequireSpread(config.tilt_rad, "tilt_rad");
  RequireSpread(config.beside_m, "beside_m");
}

RandomGraspPolicy::RandomGraspPolicy(const RandomGraspConfig& config) : config_(config) {
  CheckRandomGrasp(config);
}

std::optional<GraspAction> RandomGraspPolicy::Choose(const GraspObservation& observation) {
  const LabelledCloud& visible = observation.visible;
  const Candidates candidates = CandidatesIn(visible, config_.beside_m);
  if (candidates.handle.empty()) return std::nullopt;
  Rng rng(observation.seed, "grasp/" + observation.episode);
  const bool beside = rng.Uniform() < config_.beside_share && !candidates.beside.empty();
  const std::vector<std::size_t>& from = beside ? candidates.beside : candidates.handle;
  const std::size_t contact = from[rng.Index(static_cast<std::uint32_t>(from.size()))];
  GraspAction action;
  action.contact_m = PointOf(visible, contact).cast<double>();
  action.world_from_hand_rotation = Orientation(config_, observation, rng);
  return action;
}

}  // namespace doorforge
