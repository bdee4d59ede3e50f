// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include "doorforge/physics/robot_command.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/scene.h"

#include "collision/bullet_body.h"
#include "robot/drive_limits.h"
#include "robot/operational_space.h"

namespace doorforge::internal {

/// The robot in a world, with the drives of its joints.
class RobotBody {
 public:
  /// @param robot Must outlive this.
  RobotBody(btMultiBodyDynamicsWorld& world, const Scene& scene, const RobotModel& robot,
            const JointVector& start);

  /// What the drives are to do in the next step.
  void Command(const RobotCommand& command);

  BulletBody& body() { return body_; }
  JointVector Positions() const;
  JointVector Velocities() const;
  const btCollisionObject* collider(int joint) const { return body_.collider(joint); }
  /// Left (0) and right (1).
  const btCollisionObject* finger(int side) const {
    return body_.collider(robot_.left_finger() + side);
  }
  /// "platform", "link3", "hand", "finger"; empty where it is not one of the robot's.
  std::string NameOf(const btCollisionObject* object) const;

 private:
  void AddArmMotors(const JointVector& start);
  void AddFingers();
  void CommandArm(const RobotCommand& command);

  const RobotModel& robot_;
  double time_step_s_;
  double finger_force_n_;
  BulletBody body_;
  std::vector<btMultiBodyJointMotor*> arm_motors_;  // none where torques lead the arm
  std::optional<OperationalSpace> torques_;
  std::optional<DriveLimits> drive_limits_;  // of the motors, where they are limited further
  std::array<btMultiBodyJointMotor*, 2> finger_motors_{};
};

}  // namespace doorforge::internal
