// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "doorforge/physics/robot_command.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/scene.h"

#include "robot/drive_limits.h"
#include "robot/operational_space.h"

namespace doorforge::internal {

/// What the drives of the robot's joints are to do, in the terms of RobotBody: each wants a speed
/// and has a limit to what it may use for it, or is a torque.
class MujocoDrives {
 public:
  /// @param scene, robot Must outlive this.
  MujocoDrives(const Scene& scene, const RobotModel& robot);

  /// Sets what holds during the next step of the scene.
  void Command(const RobotCommand& command, const JointVector& position,
               const JointVector& velocity);

  /// [m/s or rad/s], of a joint that is at a position.
  double WantedSpeed(int joint, double position) const;
  double limit(int joint) const { return limit_[joint]; }    ///< [N or N m]
  double torque(int joint) const { return torque_[joint]; }  ///< The same, besides.

 private:
  const Scene& scene_;
  const RobotModel& robot_;
  RobotCommand command_;
  JointVector limit_;
  JointVector torque_;
  std::optional<OperationalSpace> torques_;
  std::optional<DriveLimits> drive_limits_;
};

}  // namespace doorforge::internal
