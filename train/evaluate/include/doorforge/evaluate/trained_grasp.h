// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "doorforge/policy/grasp_policy.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/gripper_clearance.h"
#include "doorforge/rollout/run_episode.h"

namespace doorforge {

/// A trained grasp in an episode. It looks once, through the scene's camera, before the robot comes
/// into view, as the data sets of the stage are recorded. Privileged are the handle's mask in the
/// picture and the direction into the leaf (the x of the handle's frame).
class TrainedGrasp : public GraspChooser {
 public:
  /// @param scene With the camera that the grasp is chosen by, see GraspLook.
  /// @throws as CameraObserver.
  TrainedGrasp(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
               const CloudConfig& config, std::shared_ptr<GraspPolicy> policy);

  std::optional<ChosenGrasp> Choose(const SceneSnapshot& snapshot) override;
  /// The same choice with all that it was made from.
  std::optional<GraspChoice> Consider(const SceneSnapshot& snapshot);

 private:
  int point_count_;
  CameraObserver camera_;
  GripperClearance clearance_;
  std::shared_ptr<GraspPolicy> policy_;
};

}  // namespace doorforge
