// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/physics/robot_command.h"
#include "doorforge/schemas/scene.h"

namespace doorforge::internal {

/// Torques that lead the tool centre to a pose as if it were a free body of its own inertia (Khatib
/// 1987), and the joints towards a posture in what that leaves free. There is no gravity in these
/// worlds; Coriolis forces are left to the feedback.
class OperationalSpace {
 public:
  /// @param robot Must outlive this.
  /// @param masses Of the joints' bodies as the world simulates them.
  OperationalSpace(const RobotModel& robot, const RigidTransform& world_from_base,
                   const OperationalSpaceConfig& config, std::vector<MassProperties> masses)
      : robot_(robot),
        world_from_base_(world_from_base),
        config_(config),
        masses_(std::move(masses)) {}

  /// Returns those of base and arm [N, N m], within the joints' efforts. Without a pose in the
  /// command the joints follow arm_position one by one.
  ArmVector Torques(const RobotCommand& command, const JointVector& position,
                    const JointVector& velocity) const;

 private:
  using Twist = Eigen::Matrix<double, 6, 1>;
  Twist ErrorTo(const RigidTransform& goal, const RigidTransform& now) const;
  ArmVector WithinEfforts(const ArmVector& torque) const;

  const RobotModel& robot_;
  RigidTransform world_from_base_;
  OperationalSpaceConfig config_;
  std::vector<MassProperties> masses_;
};

}  // namespace doorforge::internal
