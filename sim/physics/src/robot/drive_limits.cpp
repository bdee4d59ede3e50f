// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drive_limits.h"

#include <algorithm>

#include "doorforge/physics/mass_matrix.h"

namespace doorforge::internal {
namespace {

constexpr double kMomentArm = 0.2;        // [m]
constexpr double kTurnAcceleration = 5;   // [rad/s^2] that a joint reaches unhindered
constexpr double kSlideAcceleration = 1;  // [m/s^2]

}  // namespace

ArmVector DriveLimits::At(const JointVector& position) const {
  const RobotPose pose = robot_.PoseAt(position, world_from_base_);
  const ArmJacobian jacobian = robot_.TcpJacobian(pose);
  const JointMatrix mass = MassMatrix(robot_, pose, masses_);
  ArmVector limits(robot_.arm_count());
  for (int i = 0; i < robot_.arm_count(); ++i) {
    const double pressing = hand_force_n_ * (jacobian.col(i).head<3>().norm() +
                                             kMomentArm * jacobian.col(i).tail<3>().norm());
    const double moving =
        mass(i, i) * (robot_.joint(i).prismatic ? kSlideAcceleration : kTurnAcceleration);
    limits[i] = std::min(robot_.joint(i).effort, pressing + moving);
  }
  return limits;
}

}  // namespace doorforge::internal
