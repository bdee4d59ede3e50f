// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/simulated_robot.h"

#include "collision/bullet_body.h"

namespace doorforge::internal {
namespace {

constexpr double kHandFriction = 0.3;
constexpr double kArmFriction = 0.5;

}  // namespace

double LeastInertiaOf(const RobotJoint& joint) { return joint.prismatic ? 1e-3 : 1e-2; }

std::vector<MassProperties> SimulatedMasses(const RobotModel& robot) {
  std::vector<MassProperties> masses;
  for (const RobotJoint& joint : robot.joints())
    masses.push_back(WithLeastInertia(joint.mass, LeastInertiaOf(joint)));
  return masses;
}

std::vector<double> FrictionsOf(const RobotModel& robot, double finger_friction) {
  std::vector<double> frictions(static_cast<std::size_t>(robot.joint_count()), kArmFriction);
  for (const int finger : {robot.left_finger(), robot.right_finger()})
    frictions[static_cast<std::size_t>(finger)] = finger_friction;
  frictions[static_cast<std::size_t>(robot.arm_count()) - 1] = kHandFriction;
  return frictions;
}

std::string NameOfBody(const RobotModel& robot, int joint) {
  if (joint >= robot.arm_count()) return "finger";
  if (joint == robot.arm_count() - 1) return "hand";
  const int link = joint - robot.base_count() + 1;
  return link < 1 ? "platform" : "link" + std::to_string(link);
}

}  // namespace doorforge::internal
