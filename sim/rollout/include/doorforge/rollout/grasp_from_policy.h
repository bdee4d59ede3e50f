// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/physics/robot_model.h"
#include "doorforge/rollout/gripper_clearance.h"
#include "doorforge/rollout/snapshot_grasp_policy.h"
#include "doorforge/schemas/grasp_policy.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// A grasp policy in an episode: makes its observation of the instant before the robot moves.
/// Privileged are the handle's labels and the direction into the leaf (the x of the handle's
/// frame).
class GraspFromPolicy : public SnapshotGraspPolicy {
 public:
  /// Every point that the camera sees at an instant, without the robot; called for the first grasp
  /// of an episode, and for a further one where the leaf stands otherwise than when it was seen.
  using VisibleCloud = std::function<LabelledCloud(const SceneSnapshot&)>;

  /// @param policy Kept by reference.
  GraspFromPolicy(GraspPolicy& policy, const Scene& scene, const DoorAsset& door,
                  const RobotModel& robot, VisibleCloud visible);

  /// The chosen grasp's cloud is to be of this extent about the contact, for a record; without, it
  /// is the policy's own.
  void RecordWith(const CloudExtent& extent) { recorded_ = extent; }

  /// Called again in an episode, it passes on what was seen last and the grasps that were tried
  /// there. A leaf that has turned by more than 3 degrees since is looked at anew, and nothing was
  /// tried there yet. Throws as the policy.
  std::optional<GraspCommand> Choose(const SceneSnapshot& snapshot) override;
  /// Gives Choose()'s choice as the policy made it, with what it says of it.
  std::optional<GraspAction> ActionAt(const SceneSnapshot& snapshot);

 private:
  void Look(const SceneSnapshot& snapshot);

  GraspPolicy& policy_;
  std::uint64_t seed_;
  std::string episode_;
  DoorFacts facts_;
  RigidTransform handle_from_grasp_;
  RigidTransform hand_from_tcp_;
  GripperClearance clearance_;
  VisibleCloud visible_;
  std::optional<LabelledCloud> seen_;
  Eigen::Matrix3d leaf_when_seen_ = Eigen::Matrix3d::Identity();
  std::vector<TriedGrasp> tried_;
  std::optional<CloudExtent> recorded_;
};

}  // namespace doorforge
