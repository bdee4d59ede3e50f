// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "mujoco/mujoco_drives.h"

#include <algorithm>
#include <limits>

#include "robot/simulated_robot.h"

namespace doorforge::internal {

MujocoDrives::MujocoDrives(const Scene& scene, const RobotModel& robot)
    : scene_(scene),
      robot_(robot),
      limit_(JointVector::Zero(robot.joint_count())),
      torque_(JointVector::Zero(robot.joint_count())) {
  if (scene.physics.controller == ArmController::kOperationalSpace) {
    torques_.emplace(robot, scene.world_from_robot_base, scene.physics.operational_space,
                     SimulatedMasses(robot));
  } else if (scene.physics.hand_force_n > 0) {
    drive_limits_.emplace(robot, scene.world_from_robot_base, SimulatedMasses(robot),
                          scene.physics.hand_force_n);
  }
}

void MujocoDrives::Command(const RobotCommand& command, const JointVector& position,
                           const JointVector& velocity) {
  command_ = command;
  const int arm = robot_.arm_count();
  for (int i = 0; i < arm; ++i) limit_[i] = torques_ ? 0 : robot_.joint(i).effort;
  if (torques_) torque_.head(arm) = torques_->Torques(command, position, velocity);
  if (drive_limits_) limit_.head(arm) = command.effort_share * drive_limits_->At(position);
  const double finger = command.close_fingers ? scene_.physics.finger_force_n : kFingerOpenForce;
  limit_[robot_.left_finger()] = limit_[robot_.right_finger()] = finger;
}

double MujocoDrives::WantedSpeed(int joint, double position) const {
  const double step = scene_.physics.time_step_s;
  if (joint < robot_.arm_count()) {
    const double most = command_.most_speed ? (*command_.most_speed)[joint]
                                            : std::numeric_limits<double>::infinity();
    return std::clamp(kArmPositionGain * (command_.arm_position[joint] - position) / step, -most,
                      most);
  }
  if (command_.close_fingers) return -kFingerSpeed;
  const double open = command_.fingers_open_m.value_or(robot_.joint(robot_.left_finger()).upper);
  return std::clamp(kFingerOpeningGain * (open - position) / step, -kFingerSpeed, kFingerSpeed);
}

}  // namespace doorforge::internal
