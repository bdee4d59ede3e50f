// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/grasp_from_policy.h"

#include <numbers>
#include <utility>

namespace doorforge {
namespace {

constexpr double kAsGoodAsThereRad = 3 * std::numbers::pi / 180;  // what was seen of it still holds

}  // namespace

GraspFromPolicy::GraspFromPolicy(GraspPolicy& policy, const Scene& scene, const DoorAsset& door,
                                 const RobotModel& robot, VisibleCloud visible)
    : policy_(policy),
      seed_(scene.seed),
      episode_(scene.door_id + "/" + std::to_string(scene.episode)),
      facts_(FactsOf(door)),
      handle_from_grasp_(door.handle_from_grasp),
      hand_from_tcp_(robot.hand_from_tcp()),
      clearance_(robot),
      visible_(std::move(visible)) {}

std::optional<GraspCommand> GraspFromPolicy::Choose(const SceneSnapshot& snapshot) {
  std::optional<GraspAction> action = ActionAt(snapshot);
  if (!action) return std::nullopt;
  GraspCommand chosen;
  chosen.cloud = std::move(action->cloud);
  chosen.contact_m = action->contact_m;
  chosen.world_from_hand_rotation = action->world_from_hand_rotation;
  return chosen;
}

void GraspFromPolicy::Look(const SceneSnapshot& snapshot) {
  const Eigen::Matrix3d leaf = snapshot.door[kLeafLink].linear();
  const bool holds =
      seen_ && RotationVector(leaf * leaf_when_seen_.transpose()).norm() < kAsGoodAsThereRad;
  if (holds) return;
  seen_ = visible_(snapshot);
  leaf_when_seen_ = leaf;
  tried_.clear();
}

std::optional<GraspAction> GraspFromPolicy::ActionAt(const SceneSnapshot& snapshot) {
  GraspObservation observation;
  Look(snapshot);
  observation.visible = *seen_;
  observation.tried = tried_;
  observation.approach = -snapshot.door[kHandleLink].linear().col(0);
  observation.sample = [&](const Eigen::Vector3d& start, double crop_radius_m) {
    return SampleCloud(observation.visible, start, {.crop_radius_m = crop_radius_m}).cloud;
  };
  observation.fits = [&](const Eigen::Vector3d& contact_m, const Eigen::Matrix3d& rotation) {
    return clearance_.Fits(observation.visible, contact_m, rotation);
  };
  observation.hand_from_tcp = hand_from_tcp_;
  observation.seed = seed_;
  observation.episode = episode_;
  observation.privileged.door = facts_;
  observation.privileged.world_from_handle = snapshot.door[kHandleLink];
  observation.privileged.world_from_tcp = snapshot.door[kHandleLink] * handle_from_grasp_;
  std::optional<GraspAction> action = policy_.Choose(observation);
  if (action) tried_.push_back({action->contact_m, action->world_from_hand_rotation});
  if (action && recorded_)
    action->cloud = SampleCloud(observation.visible, action->contact_m, *recorded_).cloud;
  return action;
}

}  // namespace doorforge
