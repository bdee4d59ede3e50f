// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/grasp_plan.h"

#include <gtest/gtest.h>

#include "doorforge/physics/grasp_probe.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/physics/spawn_collision_checker.h"

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

// ---- pushed by an upright handle ----------------------------------------------------------------

constexpr double kBarAt = 0.74;  // [m] along y, of a primitive door

// A vertical bar, with a jamb in front of the leaf's free edge, as windows have it.
DoorAsset BesideAJamb(double from_bar_m, Opening opening = Opening::kPush) {
  DoorAsset door = MakePrimitiveDoor({.mechanism = Mechanism::kNone, .opening = opening});
  DoorGeometry jamb;
  jamb.name = "jamb";
  jamb.hulls = {BoxMesh({0.025, kBarAt + from_bar_m, 0}, {0.13, kBarAt + from_bar_m + 0.1, 1.9})};
  jamb.mesh = jamb.hulls.front();
  door.links[kBaseLink].geometry.push_back(jamb);
  return door;
}

// Whether the robot is outside of the door before the grasp and at it.
bool IsFree(const DoorAsset& door, const Scene& scene, const GraspPlan& plan, double fingers_m) {
  const RobotModel robot = LoadMobileFranka();
  const SpawnCollisionChecker checker(door, robot);
  for (JointVector position : {plan.pregrasp, plan.grasp}) {
    position.tail<2>().setConstant(fingers_m);
    if (checker.Find(robot.PoseAt(position, scene.world_from_robot_base), scene.world_from_door))
      return false;
  }
  return true;
}

TEST(GraspPlan, WhoPushesOpensTheFingersAsFarAsThereIsRoomBesideTheJamb) {
  const RobotModel robot = LoadMobileFranka();
  const double wide = robot.joint(robot.left_finger()).upper;
  for (const double room_m : {0.035, 0.2}) {
    const DoorAsset door = BesideAJamb(room_m);
    ASSERT_TRUE(IsPushedUpright(door));
    const Scene scene = StillScene(door);
    const GraspPlan plan = PlanGrasp(scene, door, robot);
    EXPECT_TRUE(IsFree(door, scene, plan, plan.fingers_open_m.value_or(wide))) << room_m;
    EXPECT_EQ(IsFree(door, scene, plan, wide), !plan.fingers_open_m) << room_m;
    EXPECT_EQ(plan.fingers_open_m.has_value(), room_m < 0.1);
    EXPECT_GT(plan.step_back_m, 0);
  }
}

TEST(GraspPlan, WhoPullsOpensThemAllTheWay) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = BesideAJamb(0.035, Opening::kPull);
  const GraspPlan plan = PlanGrasp(StillScene(door), door, robot);
  EXPECT_FALSE(plan.fingers_open_m);
  EXPECT_EQ(plan.step_back_m, 0);
}

// A door that comes nearer: the first piece that is too near counts by as much.
TEST(SpawnCollisionChecker, CrowdingGrowsAsAWallComesNearer) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = StillScene(door);
  const SpawnCollisionChecker checker(door, robot);
  const RobotPose pose = robot.PoseAt(robot.InitialPosition(), scene.world_from_robot_base);
  EXPECT_EQ(checker.Crowding(pose, scene.world_from_door, 0.005), 0);
  // moved until the first piece is within 5 mm: only it counts, by as much as the wall moves on
  RigidTransform wall = scene.world_from_door;
  while (checker.Crowding(pose, wall, 0.005) == 0) wall.translation().x() += 1e-4;
  const double before = checker.Crowding(pose, wall, 0.005);
  EXPECT_LE(before, 1.1e-4);
  wall.translation().x() += 0.002;
  EXPECT_NEAR(checker.Crowding(pose, wall, 0.005), before + 0.002, 1e-4);
  wall.translation().x() += 0.2;  // far inside
  EXPECT_GE(checker.Crowding(pose, wall, 0.005), 0.02);
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
