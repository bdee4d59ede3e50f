// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/rollout/snapshot_grasp_policy.h"

namespace doorforge {

/// The rule that takes hold of the handle: PlanGrasp()'s grasp, which both pads have to touch.
/// Looks at nothing.
class ExpertGrasp : public SnapshotGraspPolicy {
 public:
  /// @param scene, door, robot Must outlive this.
  ExpertGrasp(const Scene& scene, const DoorAsset& door, const RobotModel& robot)
      : scene_(scene), door_(door), robot_(robot) {}

  std::optional<GraspCommand> Choose(const SceneSnapshot& snapshot) override;

 private:
  const Scene& scene_;
  const DoorAsset& door_;
  const RobotModel& robot_;
};

}  // namespace doorforge
