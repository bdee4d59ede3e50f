// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/inverse_kinematics.h"

#include <array>

#include <Eigen/Cholesky>

namespace doorforge {
namespace {

using Twist = Eigen::Matrix<double, 6, 1>;

Twist ErrorTo(const RigidTransform& goal, const RigidTransform& now) {
  Twist error;
  error.head<3>() = goal.translation() - now.translation();
  error.tail<3>() = RotationVector(goal.linear() * now.linear().transpose());
  return error;
}

Twist Shortened(Twist error, const InverseKinematicsConfig& config) {
  const double distance = error.head<3>().norm();
  const double angle = error.tail<3>().norm();
  if (distance > config.max_position_step_m)
    error.head<3>() *= config.max_position_step_m / distance;
  if (angle > config.max_rotation_step_rad) error.tail<3>() *= config.max_rotation_step_rad / angle;
  return error;
}

using TwistSolver = Eigen::LDLT<Eigen::Matrix<double, 6, 6>>;

TwistSolver DampedSolver(const ArmJacobian& jacobian, const ArmVector& weight, double damping) {
  const Eigen::Matrix<double, 6, 6> normal =
      jacobian * weight.asDiagonal() * jacobian.transpose() +
      damping * damping * Eigen::Matrix<double, 6, 6>::Identity();
  return TwistSolver(normal);
}

// Step of the joints with weight 1; the others stay.
ArmVector DampedStep(const ArmJacobian& jacobian, const ArmVector& weight, const Twist& twist,
                     const ArmVector& posture_step, double damping) {
  // The null space needs a sharper inverse than the task: with equal damping the posture would pull
  // the hand some millimetres off in directions that the arm hardly reaches.
  constexpr double kNullSpaceSharpness = 0.1;
  const ArmVector free_step = weight.cwiseProduct(posture_step);
  const Twist moved =
      DampedSolver(jacobian, weight, kNullSpaceSharpness * damping).solve(jacobian * free_step);
  const Twist pulled = DampedSolver(jacobian, weight, damping).solve(twist);
  return free_step + weight.asDiagonal() * jacobian.transpose() * (pulled - moved);
}

}  // namespace

JointVector StepTowards(const RobotModel& robot, const RigidTransform& world_from_base,
                        const InverseKinematicsGoal& goal, const JointVector& position,
                        const InverseKinematicsConfig& config) {
  const RobotPose pose = robot.PoseAt(position, world_from_base);
  const ArmJacobian jacobian = robot.TcpJacobian(pose);
  const Twist twist =
      config.gain * Shortened(ErrorTo(goal.world_from_tcp, pose.world_from_tcp), config);
  ArmVector posture_step = config.posture_gain * (goal.posture - position).head(robot.arm_count());
  posture_step.head(robot.base_count()).setZero();

  ArmVector weight = ArmVector::Ones(robot.arm_count());
  ArmVector step = ArmVector::Zero(robot.arm_count());
  // each pass freezes at least one joint; after four the hand has lost too many to be steered
  for (int pass = 0; pass < 4; ++pass) {
    step = DampedStep(jacobian, weight, twist, posture_step, config.damping);
    bool frozen = false;
    for (int i = robot.base_count(); i < robot.arm_count(); ++i) {
      const RobotJoint& joint = robot.joint(i);
      const double next = position[i] + step[i];
      const bool runs_out = (next > joint.upper - config.limit_margin_rad && step[i] > 0) ||
                            (next < joint.lower + config.limit_margin_rad && step[i] < 0);
      if (weight[i] == 0 || !runs_out) continue;
      weight[i] = 0;
      frozen = true;
    }
    if (!frozen) break;
  }
  JointVector next = position;
  next.head(robot.arm_count()) += step;
  return robot.Clamped(next);
}

InverseKinematicsSolution SolveInverseKinematics(const RobotModel& robot,
                                                 const RigidTransform& world_from_base,
                                                 const InverseKinematicsGoal& goal,
                                                 const JointVector& start) {
  InverseKinematicsSolution solution;
  solution.position = robot.Clamped(start);
  for (int i = 0; i < 300; ++i) {
    const RobotPose pose = robot.PoseAt(solution.position, world_from_base);
    const Twist error = ErrorTo(goal.world_from_tcp, pose.world_from_tcp);
    solution.position_error_m = error.head<3>().norm();
    solution.rotation_error_rad = error.tail<3>().norm();
    if (solution.position_error_m < 5e-4 && solution.rotation_error_rad < 2e-3) break;
    solution.position = StepTowards(robot, world_from_base, goal, solution.position);
  }
  return solution;
}

}  // namespace doorforge
