// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "doorforge/physics/robot_model.h"
#include "doorforge/validate/validate_door.h"

namespace doorforge {

/// The check of the rules SWP and OPN, for DoorValidator: moves the leaf past its frame, simulates
/// latch, handle and hinge under a turn and a pull, and looks for a grasp of the robot's gripper.
/// The rules and their limits are those of `validate`, the measures those of physics and rollout.
class OpenableCheck {
 public:
  /// Throws as LoadMobileFranka().
  OpenableCheck();

  /// Throws Error(kInvalidArgument) for a door that cannot be simulated, such as one with a bolt.
  std::vector<Finding> operator()(const DoorAsset& door) const;

 private:
  std::shared_ptr<const RobotModel> robot_;
};

}  // namespace doorforge
