// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/operational_space.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "doorforge/physics/mass_matrix.h"

namespace doorforge::internal {
namespace {

// It is added to the hand's inverse inertia: where the arm is stretched out, it keeps the forces
// finite.
constexpr double kLeastMobility = 1e-4;

double CriticalDamping(double stiffness) { return 2 * std::sqrt(stiffness); }

template <class Vector>
void Shorten(Vector&& v, double most) {
  const double length = v.norm();
  if (length > most) v *= most / length;
}

}  // namespace

OperationalSpace::Twist OperationalSpace::ErrorTo(const RigidTransform& goal,
                                                  const RigidTransform& now) const {
  Twist error;
  error.head<3>() = goal.translation() - now.translation();
  error.tail<3>() = RotationVector(goal.linear() * now.linear().transpose());
  Shorten(error.head<3>(), config_.lead_m);
  Shorten(error.tail<3>(), config_.lead_rad);
  return error;
}

ArmVector OperationalSpace::WithinEfforts(const ArmVector& torque) const {
  ArmVector limited = torque;
  for (int i = 0; i < robot_.arm_count(); ++i)
    limited[i] = std::clamp(torque[i], -robot_.joint(i).effort, robot_.joint(i).effort);
  return limited;
}

ArmVector OperationalSpace::Torques(const RobotCommand& command, const JointVector& position,
                                    const JointVector& velocity) const {
  using ArmMatrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostArmJoints, kMostArmJoints>;
  const int count = robot_.arm_count();
  const RobotPose pose = robot_.PoseAt(position, world_from_base_);
  ArmMatrix mass = MassMatrix(robot_, pose, masses_).topLeftCorner(count, count);
  mass.diagonal().array() += config_.armature;
  const ArmVector speed = velocity.head(count);
  const ArmVector behind = command.arm_position - position.head(count);
  if (!command.world_from_tcp)
    return WithinEfforts(mass * (config_.kp * behind - CriticalDamping(config_.kp) * speed));

  const ArmJacobian jacobian = robot_.TcpJacobian(pose);
  const Eigen::LDLT<ArmMatrix> mass_solver(mass);
  const Eigen::Matrix<double, Eigen::Dynamic, 6, 0, kMostArmJoints, 6> response =
      mass_solver.solve(jacobian.transpose());
  const Eigen::Matrix<double, 6, 6> mobility =
      jacobian * response + kLeastMobility * Eigen::Matrix<double, 6, 6>::Identity();
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> hand_inertia(mobility);

  const Twist acceleration = config_.kp * ErrorTo(*command.world_from_tcp, pose.world_from_tcp) -
                             CriticalDamping(config_.kp) * (jacobian * speed);
  const ArmVector free_acceleration =
      config_.posture_kp * behind - CriticalDamping(config_.posture_kp) * speed;
  // what the posture would do to the hand is taken out of the hand's own acceleration
  const Twist hand = acceleration - jacobian * free_acceleration;
  return WithinEfforts(mass * free_acceleration + jacobian.transpose() * hand_inertia.solve(hand));
}

}  // namespace doorforge::internal
