// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/level_postures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>

#include "doorforge/core/rng.h"
#include "doorforge/physics/inverse_kinematics.h"

#include "robot/self_collision.h"

namespace doorforge::internal {
namespace {

constexpr int kTries = 40;                 // of each roll
constexpr double kLeastJointHeight = 0.1;  // [m] of a joint over the base
constexpr double kUnreached = 100;

JointVector Relaxed(const RobotModel& robot) {
  JointVector position = JointVector::Zero(robot.joint_count());
  position.tail<2>().setConstant(robot.joint(robot.left_finger()).upper);
  return position;
}

// Facing the door with a level hand; the sliders take the distance.
JointVector FrankaPosture(const RobotModel& robot, double last_joint) {
  JointVector posture = Relaxed(robot);
  const int arm = robot.base_count();
  posture[arm + 1] = -0.3;
  posture[arm + 3] = -2.1;
  posture[arm + 5] = posture[arm + 1] - posture[arm + 3] + std::numbers::pi / 2;
  posture[arm + 6] = last_joint;
  return posture;
}

bool IsBuiltLikeFranka(const RobotModel& robot) {
  if (robot.arm_count() - robot.base_count() != 7) return false;
  const JointVector posture = FrankaPosture(robot, 0.785);
  const RobotPose pose = robot.PoseAt(posture, RigidTransform::Identity());
  return robot.Clamped(posture) == posture && pose.world_from_tcp.linear().col(2).x() > 0.99 &&
         pose.world_from_tcp.translation().x() > 0.3;
}

// It returns the length of the stretched arm: no tool is farther from the base joint.
double LengthOf(const RobotModel& robot) {
  double length = robot.tcp().body_from_frame.translation().norm();
  for (int i = robot.base_count() + 1; i < robot.arm_count(); ++i)
    length += robot.joint(i).parent_from_joint.translation().norm();
  return length;
}

double CostOf(const RobotModel& robot, const JointVector& position) {
  double cost = 0;
  for (int i = robot.base_count(); i < robot.arm_count(); ++i) {
    const RobotJoint& joint = robot.joint(i);
    const double middle = (joint.lower + joint.upper) / 2;
    const double half = std::min((joint.upper - joint.lower) / 2, std::numbers::pi);
    cost += std::pow((position[i] - middle) / half, 4);
  }
  const RobotPose pose = robot.PoseAt(position, RigidTransform::Identity());
  const double base_height = pose.world_from_body[0].translation().z();
  for (int i = robot.base_count() + 1; i < robot.arm_count(); ++i) {
    const double height = pose.world_from_body[static_cast<std::size_t>(i)].translation().z();
    cost += 20 * std::max(0.0, kLeastJointHeight - (height - std::min(base_height, 0.0)));
  }
  // Yoshikawa's measure of the arm alone
  const ArmJacobian all = robot.TcpJacobian(pose);
  const auto arm = all.rightCols(robot.arm_count() - robot.base_count());
  const Eigen::Matrix<double, 6, 6> square = arm * arm.transpose();
  return cost + 0.05 / std::sqrt(std::max(square.determinant(), 1e-8));
}

JointVector SearchedPosture(const RobotModel& robot, double roll) {
  const double length = LengthOf(robot);
  RigidTransform level = Translation({0.6 * length, 0, std::clamp(0.7 * length, 0.55, 0.9)});
  level.linear() << 0, 0, 1, 0, 1, 0, -1, 0, 0;  // z of the tool ahead, y to the left
  level.rotate(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()));
  Rng rng(1, "level postures");
  JointVector best = robot.InitialPosition();
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTries; ++i) {
    JointVector start = Relaxed(robot);
    for (int j = robot.base_count(); j < robot.arm_count(); ++j)
      start[j] = rng.Uniform(std::max(robot.joint(j).lower, -std::numbers::pi),
                             std::min(robot.joint(j).upper, std::numbers::pi));
    const auto solution =
        SolveInverseKinematics(robot, RigidTransform::Identity(), {level, start}, start);
    const double cost = CostOf(robot, solution.position) + (solution.Reached() ? 0 : kUnreached);
    if (cost >= least || TouchesItself(robot, solution.position)) continue;
    least = cost;
    best = solution.position;
  }
  best.head(robot.base_count()).setZero();
  return best;
}

}  // namespace

std::vector<JointVector> LevelPostures(const RobotModel& robot) {
  std::vector<JointVector> postures;
  if (robot.base() == RobotBase::kFloating) {
    for (const double roll : {0.0, 0.5, 1.0, -0.5}) {
      postures.push_back(Relaxed(robot));
      postures.back()[robot.arm_count() - 1] = roll * std::numbers::pi;
    }
    return postures;
  }
  if (IsBuiltLikeFranka(robot)) {
    for (const double last_joint : {-0.785, 0.785, 2.356, -2.356})
      postures.push_back(FrankaPosture(robot, last_joint));
    return postures;
  }
  for (const double roll : {0.0, 0.5, 1.0, -0.5})
    postures.push_back(SearchedPosture(robot, roll * std::numbers::pi));
  return postures;
}

}  // namespace doorforge::internal
