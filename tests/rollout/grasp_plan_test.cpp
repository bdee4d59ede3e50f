// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/grasp_plan.h"

#include <gtest/gtest.h>

#include "doorforge/physics/grasp_probe.h"
#include "doorforge/physics/scene_sampling.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

Scene StillScene(const DoorAsset& door) {
  SceneConfig config;
  config.base_jitter = 0;
  config.grasp_noise = 0;
  return SampleScene(door, 1, 0, config);
}

double DistanceToGrasp(const DoorAsset& door, const GraspPlan& plan) {
  return (plan.handle_from_tcp.translation() - door.handle_from_grasp.translation()).norm();
}

TEST(GraspPlan, KeepsAGraspThatIsGood) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const GraspPlan plan = PlanGrasp(StillScene(door), door, robot);
  EXPECT_LT(plan.cost, 0.3);
  EXPECT_LT(DistanceToGrasp(door, plan), 0.001);
  const double along =
      plan.handle_from_tcp.linear().col(1).dot(door.handle_from_grasp.linear().col(1));
  EXPECT_NEAR(std::abs(along), 1, 1e-6);  // the same closing direction, either way round
}

TEST(GraspPlan, TheArmIsAtTheGraspAndBeforeIt) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = StillScene(door);
  const GraspPlan plan = PlanGrasp(scene, door, robot);
  const RigidTransform goal =
      scene.world_from_door * DoorFromLinks(door, 0, 0)[kHandleLink] * plan.handle_from_tcp;
  const RobotPose at = robot.PoseAt(plan.grasp, scene.world_from_robot_base);
  const RobotPose before = robot.PoseAt(plan.pregrasp, scene.world_from_robot_base);
  EXPECT_LT((at.world_from_tcp.translation() - goal.translation()).norm(), 2e-3);
  EXPECT_NEAR((before.world_from_tcp.translation() - goal.translation()).norm(), kPregraspDistance,
              3e-3);
}

TEST(GraspPlan, MovesAGraspThatMissesTheBarAcrossItsDepth) {
  const RobotModel robot = LoadMobileFranka();
  DoorAsset door = MakePrimitiveDoor({});
  door.handle_from_grasp.translate(Eigen::Vector3d(0, 0.006, -0.018));
  const GraspPlan plan = PlanGrasp(StillScene(door), door, robot);
  EXPECT_LT(plan.cost, 1);
  EXPECT_GT(DistanceToGrasp(door, plan), 0.005);
}

TEST(GraspPlan, SaysByItsCostThatAHandleIsOutOfTheGripper) {
  const RobotModel robot = LoadMobileFranka();
  PrimitiveDoor shape;
  shape.mechanism = Mechanism::kRound;
  shape.radius_m = 0.06;  // the gripper opens 8 cm
  const DoorAsset door = MakePrimitiveDoor(shape);
  EXPECT_GT(PlanGrasp(StillScene(door), door, robot).cost, 4);
}

// Room for a turn either way is all that counts: the grasp and its half turn are one grasp, and of
// their postures the one with the wrist nearest to the middle of its range is taken.
TEST(PlanReach, ReachesTheGraspOrItsHalfTurnWithRoomForTheWrist) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = StillScene(door);
  const RigidTransform world_from_grasp =
      scene.world_from_door * DoorFromLinks(door, 0, 0)[kHandleLink] * door.handle_from_grasp;
  const int wrist = robot.arm_count() - 1;
  const double middle = (robot.joint(wrist).lower + robot.joint(wrist).upper) / 2;
  for (const double roll : {0.0, 0.6, 1.2, 2.0, 3.0}) {
    const RigidTransform asked = world_from_grasp * RotationAbout(Eigen::Vector3d::UnitZ(), roll);
    const ArmReach reach = PlanReach(scene, robot, asked);
    const RobotPose at = robot.PoseAt(reach.grasp, scene.world_from_robot_base);
    const RobotPose before = robot.PoseAt(reach.pregrasp, scene.world_from_robot_base);
    EXPECT_LT((at.world_from_tcp.translation() - asked.translation()).norm(), 2e-3);
    EXPECT_NEAR((before.world_from_tcp.translation() - asked.translation()).norm(),
                kPregraspDistance, 3e-3);
    const double along = at.world_from_tcp.linear().col(1).dot(asked.linear().col(1));
    EXPECT_NEAR(std::abs(along), 1, 1e-3) << "the fingers close along the same line";
    EXPECT_LT(std::abs(reach.grasp[wrist] - middle), 1.75) << "a quarter turn, and some reserve";
  }
}

}  // namespace
}  // namespace doorforge
