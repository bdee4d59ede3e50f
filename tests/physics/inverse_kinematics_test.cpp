// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/inverse_kinematics.h"

#include <gtest/gtest.h>

#include "doorforge/core/rng.h"

namespace doorforge {
namespace {

TEST(InverseKinematics, FindsPosesThatForwardKinematicsMade) {
  const RobotModel robot = LoadMobileFranka();
  const RigidTransform base = FromXyzRpy({0.7, 0, 0.1}, {0, 0, 3.14});
  int reached = 0;
  for (int i = 0; i < 40; ++i) {
    Rng rng(1, "ik/" + std::to_string(i));
    JointVector truth = robot.InitialPosition();
    for (int j = 0; j < kArmJointCount; ++j) truth[j] += rng.Uniform(-0.4, 0.4);
    truth = robot.Clamped(truth);
    const RigidTransform goal = robot.PoseAt(truth, base).world_from_tcp;
    const auto solution = SolveInverseKinematics(robot, base, {goal, robot.InitialPosition()},
                                                 robot.InitialPosition());
    const RigidTransform found = robot.PoseAt(solution.position, base).world_from_tcp;
    EXPECT_NEAR((found.translation() - goal.translation()).norm(), solution.position_error_m,
                1e-12);
    reached += solution.Reached() ? 1 : 0;
  }
  EXPECT_EQ(reached, 40);
}

TEST(InverseKinematics, ASaturatedJointDoesNotLeaveAnError) {
  const RobotModel robot = LoadMobileFranka();
  const RigidTransform base = RigidTransform::Identity();
  JointVector start = robot.InitialPosition();
  start[7] = robot.joints()[7].upper;  // joint 6 of the arm cannot go on
  RigidTransform goal = robot.PoseAt(start, base).world_from_tcp;
  goal.rotate(Eigen::AngleAxisd(-0.3, goal.linear().transpose() * Eigen::Vector3d::UnitY()));
  for (const double turn : {-0.3, 0.3}) {
    RigidTransform turned = robot.PoseAt(start, base).world_from_tcp;
    turned.rotate(Eigen::AngleAxisd(turn, turned.linear().transpose() * Eigen::Vector3d::UnitY()));
    const auto solution = SolveInverseKinematics(robot, base, {turned, start}, start);
    EXPECT_TRUE(solution.Reached()) << turn << ": " << solution.position_error_m;
  }
}

TEST(InverseKinematics, StaysInsideTheLimits) {
  const RobotModel robot = LoadMobileFranka();
  const RigidTransform far_away = Translation({5, 5, 5});
  const auto solution =
      SolveInverseKinematics(robot, RigidTransform::Identity(), {far_away, robot.InitialPosition()},
                             robot.InitialPosition());
  EXPECT_FALSE(solution.Reached());
  EXPECT_EQ(solution.position, robot.Clamped(solution.position));
}

}  // namespace
}  // namespace doorforge
