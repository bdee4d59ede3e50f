// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/base_placement.h"

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/physics/spawn_collision_checker.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

// A door whose frame bulges out to `reach_m`, in the door's frame.
DoorAsset BulgingDoor(double reach_m) {
  DoorAsset door = MakePrimitiveDoor({});
  DoorGeometry bulge;
  bulge.name = "bulge";
  bulge.hulls = {BoxMesh({-0.2, -0.6, 0}, {reach_m, 1.4, 1.9})};
  door.links[kBaseLink].geometry.push_back(bulge);
  return door;
}

bool StartsInside(const RobotModel& robot, const Scene& scene, const DoorAsset& door,
                  double farther_m = 0) {
  RigidTransform base = scene.world_from_robot_base;
  base.translation().x() += farther_m;
  return SpawnCollisionChecker(door, robot)
      .Find(robot.PoseAt(StartPosition(scene, robot), base), scene.world_from_door)
      .has_value();
}

TEST(StandingPlace, IsTheScenesOwnWhereTheRobotIsFree) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene sampled = SampleScene(door, 4, 0);
  const Scene scene = PlaceRobotBase(robot, sampled, door);
  EXPECT_EQ(scene.world_from_robot_base.matrix(), sampled.world_from_robot_base.matrix());
  EXPECT_FALSE(StartsInside(robot, scene, door));
}

TEST(StandingPlace, IsJustOutsideOfABodyThatBulges) {
  const RobotModel robot = LoadMobileFranka();
  for (const double reach_m : {0.25, 0.35, 0.5}) {
    const DoorAsset door = BulgingDoor(reach_m);
    const Scene sampled = SampleScene(door, 4, 0);
    ASSERT_TRUE(StartsInside(robot, sampled, door)) << reach_m;
    const Scene scene = PlaceRobotBase(robot, sampled, door);
    EXPECT_FALSE(StartsInside(robot, scene, door)) << reach_m;
    EXPECT_TRUE(StartsInside(robot, scene, door, -0.021)) << reach_m << ": farther than need be";
    const Eigen::Vector3d moved =
        scene.world_from_robot_base.translation() - sampled.world_from_robot_base.translation();
    EXPECT_GT(moved.x(), 0);
    EXPECT_EQ(moved.tail<2>().norm(), 0);
  }
}

TEST(StandingPlace, IsRefusedInABodyWithoutAnEnd) {
  const DoorAsset door = BulgingDoor(3);
  for (const RobotBase base : {RobotBase::kSliders, RobotBase::kFixed}) {
    const RobotModel robot = LoadRobot({}, base);
    try {
      PlaceRobotBase(robot, SampleScene(door, 4, 0), door);
      ADD_FAILURE() << "the robot was put into a wall";
    } catch (const Error& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find("would start inside its \"bulge\""), std::string::npos) << text;
    }
  }
}

}  // namespace
}  // namespace doorforge
