// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Other robots than the built-in one, and other bases, open doors.

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/robot_meshes/robot_meshes.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/proprioception.h"
#include "doorforge/rollout/run_episode.h"

#include "../physics/box_arm.h"
#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

Episode Open(const RobotModel& robot, const DoorAsset& door, std::uint64_t seed,
             ArmController controller = ArmController::kJointMotors) {
  SceneConfig config;
  config.physics.base = robot.base();
  config.physics.controller = controller;
  OpeningExpert expert;
  return RunEpisode(PlaceRobotBase(robot, SampleScene(door, seed, 0, config), door), door, robot,
                    expert, nullptr);
}

int OpenedOf(const RobotModel& robot, int doors, ArmController controller) {
  int opened = 0;
  for (int i = 0; i < doors; ++i) {
    const auto index = static_cast<std::uint64_t>(i);
    const DoorAsset door = MakePrimitiveDoor(RandomPrimitive(Mechanism::kLever, 8, index));
    opened += Open(robot, door, 8, controller).outcome == EpisodeOutcome::kOpened ? 1 : 0;
  }
  return opened;
}

TEST(Robots, TheBuiltInArmOpensDoorsWithTorquesToo) {
  EXPECT_GE(OpenedOf(LoadMobileFranka(), 5, ArmController::kOperationalSpace), 4);
}

TEST(Robots, ATurntableUnderTheArmDoesNotHinderIt) {
  EXPECT_GE(OpenedOf(LoadRobot({}, RobotBase::kYaw), 5, ArmController::kJointMotors), 4);
}

TEST(Robots, AFixedBaseStandsBesideTheLeafAndIsRecorded) {
  const RobotModel robot = LoadRobot({}, RobotBase::kFixed);
  const DoorAsset door = MakePrimitiveDoor({});
  const Episode episode = Open(robot, door, 8);
  EXPECT_TRUE(HasProprioception(robot));
  EXPECT_NE(episode.outcome, EpisodeOutcome::kNotReached) << episode.detail;
  EXPECT_EQ(episode.scene.physics.base, RobotBase::kFixed);
  EXPECT_TRUE(episode.scene.robot.sha256.empty());
}

TEST(Robots, AFlyingHandOpensDoors) {
  const RobotModel robot = LoadRobot({}, RobotBase::kFloating);
  EXPECT_GE(OpenedOf(robot, 8, ArmController::kJointMotors), 7);
}

TEST(Robots, AFlyingHandsProprioceptionHasItsJointsInTheFirstPlaces) {
  const RobotModel robot = LoadRobot({}, RobotBase::kFloating);
  WorldState state;
  state.robot_position = robot.InitialPosition();
  state.robot_velocity = JointVector::Zero(robot.joint_count());
  state.robot_position[5] = robot.joint(5).upper / 2;  // roll
  state.robot_velocity[2] = 0.25;
  const Proprioception seen = ProprioceptionOf(robot, state, RigidTransform::Identity());
  EXPECT_FLOAT_EQ(seen[5], 0.5F);
  EXPECT_FLOAT_EQ(seen[9], 1.0F);  // the fingers are open
  EXPECT_FLOAT_EQ(seen[11 + 2], 0.25F);
  for (const std::size_t empty : {6U, 7U, 8U, 11U + 6, 11U + 7, 11U + 8})
    EXPECT_EQ(seen.at(empty), 0);
}

TEST(Robots, AnArmOfAnotherMakeGraspsADoorsHandle) {
  const RobotModel robot = BuildRobot(BoxArm(), {}, RobotBase::kSliders);
  const DoorAsset door = MakePrimitiveDoor({});
  const Episode episode = Open(robot, door, 8);
  EXPECT_FALSE(HasProprioception(robot));
  EXPECT_EQ(episode.scene.robot.name, "box_arm");
  EXPECT_EQ(episode.scene.robot.sha256, robot.sha256());
  EXPECT_NE(episode.outcome, EpisodeOutcome::kNotReached) << episode.detail;
  EXPECT_NE(episode.outcome, EpisodeOutcome::kGraspMissed) << episode.detail;
  // the same scene is not played by another robot
  OpeningExpert expert;
  Scene scene = episode.scene;
  EXPECT_THROW(RunEpisode(scene, door, LoadMobileFranka(), expert, nullptr), Error);
}

TEST(Robots, TheRealPandaLoadsAndOpensADoor) {
  const fs::path shared = fs::path(DOORFORGE_SOURCE_DIR).parent_path() / "shared" / "assets";
  if (!fs::exists(shared / "unpack.sh")) GTEST_SKIP() << "no shared assets beside the checkout";
  const fs::path folder = fs::path(DOORFORGE_BINARY_DIR) / "real_panda";
  if (!RobotMeshes()) GTEST_SKIP() << "built without the reader of mesh files";
  const std::string command =
      "bash '" + (shared / "unpack.sh").string() + "' '" + folder.string() + "' panda > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const RobotModel robot =
      LoadRobot(folder / "panda_bullet" / "panda.urdf", RobotBase::kSliders, RobotMeshes());
  EXPECT_EQ(robot.joint_count(), kRobotJointCount);
  EXPECT_TRUE(HasProprioception(robot));
  // hand and tool centre where the built-in robot, drawn anew from the same arm, has them
  const RobotModel own = LoadMobileFranka();
  const RobotPose theirs = robot.PoseAt(own.InitialPosition(), RigidTransform::Identity());
  const RobotPose ours = own.PoseAt(own.InitialPosition(), RigidTransform::Identity());
  EXPECT_TRUE(theirs.world_from_hand.isApprox(ours.world_from_hand, 1e-6));
  EXPECT_LT((theirs.world_from_tcp.translation() - ours.world_from_tcp.translation()).norm(), 5e-3);
  EXPECT_EQ(Open(robot, MakePrimitiveDoor({}), 8).outcome, EpisodeOutcome::kOpened);
}

}  // namespace
}  // namespace doorforge
