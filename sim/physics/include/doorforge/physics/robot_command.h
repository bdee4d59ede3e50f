// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/physics/robot_model.h"

namespace doorforge {

/// What the robot's drives are asked for during one step.
struct RobotCommand {
  ArmVector arm_position;      ///< Position targets of sliders and arm.
  bool close_fingers = false;  ///< Squeeze with finger_force_n, or open.
  /// How far from the middle a finger opens [m]; without it, all the way.
  std::optional<double> fingers_open_m = std::nullopt;
  /// Where the tool centre is to be; ArmController::kOperationalSpace alone looks at it. Without
  /// it, and with kJointMotors, the joints follow arm_position.
  std::optional<RigidTransform> world_from_tcp = std::nullopt;
  /// No joint motor moves its joint faster towards arm_position [rad/s or m/s]; without it, as fast
  /// as its effort lets it.
  std::optional<ArmVector> most_speed = std::nullopt;
  /// The joint motors use this share of what PhysicsConfig::hand_force_n leaves to them; (0, 1].
  double effort_share = 1;
};

}  // namespace doorforge
