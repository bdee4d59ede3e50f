// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/camera_observer.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/run_episode.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

TEST(CameraObserver, EveryDecisionSeesDoorAndRobotAndThePhysicsIsTheSame) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  OpeningExpert expert;
  CameraObserver camera(scene, door, robot);
  const Episode seen = RunEpisode(scene, door, robot, expert, &camera);
  const Episode blind = RunEpisode(scene, door, robot, expert, nullptr);
  EXPECT_EQ(seen.state_sha256, blind.state_sha256);
  ASSERT_FALSE(seen.decisions.empty());
  for (const Decision& decision : seen.decisions) {
    ASSERT_EQ(decision.cloud.label.size(), 4096U);
    for (const PointLabel label : {PointLabel::kBody, PointLabel::kRobot})
      EXPECT_GT(std::count(decision.cloud.label.begin(), decision.cloud.label.end(),
                           static_cast<std::uint8_t>(label)),
                50);
    // point 0 is near the gripper
    const Eigen::Vector3f hand = HandPositionOf(decision.proprioception);
    const Eigen::Vector3f first(decision.cloud.xyz[0], decision.cloud.xyz[1],
                                decision.cloud.xyz[2]);
    EXPECT_LT((first - hand).norm(), 0.2F);
  }
}

TEST(CameraObserver, AWholeCloudHasWhatTheCameraCannotSeeAndTheRobotCanBeLeftOut) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  SceneSnapshot now;
  now.robot = robot.PoseAt(StartPosition(scene, robot), scene.world_from_robot_base);
  now.door = DoorFromLinks(door, 0, 0);
  for (RigidTransform& pose : now.door) pose = scene.world_from_door * pose;
  Eigen::AlignedBox3d leaf;
  for (const DoorGeometry& geometry : door.links[kLeafLink].geometry)
    for (const Eigen::Vector3d& vertex : geometry.mesh.vertices) leaf.extend(now.door[1] * vertex);
  const auto seen = [&](bool whole, bool with_robot) {
    CloudConfig config;
    config.whole = whole;
    config.robot = with_robot;
    return CameraObserver(scene, door, robot, config).Observe(now);
  };
  const auto behind = [&](const LabelledCloud& cloud) {
    int count = 0;
    for (std::size_t i = 0; i < cloud.label.size(); ++i)
      count += cloud.label[i] == static_cast<std::uint8_t>(PointLabel::kBody) &&
               cloud.xyz[3 * i] < static_cast<float>(leaf.min().x()) + 0.001F;
    return count;
  };
  EXPECT_EQ(behind(seen(false, true)), 0);  // the leaf's back
  EXPECT_GT(behind(seen(true, true)), 500);
  for (const bool whole : {false, true}) {
    for (const bool with_robot : {false, true}) {
      const LabelledCloud cloud = seen(whole, with_robot);
      EXPECT_EQ(cloud.label.size(), 4096U);
      EXPECT_EQ(std::ranges::count(cloud.label, static_cast<std::uint8_t>(PointLabel::kRobot)) > 0,
                with_robot);
    }
  }
}

// What a hand is to be shown: the points about it alone, as many as it asks for.
TEST(CameraObserver, SamplesWhatIsNearOnRequest) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  SceneSnapshot now;
  now.robot = robot.PoseAt(StartPosition(scene, robot), scene.world_from_robot_base);
  now.door = DoorFromLinks(door, 0, 0);
  for (RigidTransform& pose : now.door) pose = scene.world_from_door * pose;
  CameraObserver camera(scene, door, robot);
  const LabelledCloud all = camera.Observe(now);
  camera.SampleAs({200, 0.25});
  const LabelledCloud near = camera.Observe(now);
  ASSERT_EQ(near.label.size(), 200U);
  const auto point = [](const LabelledCloud& cloud, std::size_t i) {
    return Eigen::Vector3f(cloud.xyz[3 * i], cloud.xyz[3 * i + 1], cloud.xyz[3 * i + 2]);
  };
  EXPECT_EQ(point(near, 0), point(all, 0));
  float farthest = 0;
  for (std::size_t i = 0; i < 200; ++i)
    farthest = std::max(farthest, (point(near, i) - point(near, 0)).norm());
  EXPECT_LE(farthest, 0.25F);
  EXPECT_GT(farthest, 0.2F);
  EXPECT_THROW(camera.SampleAs({0, 0.25}), Error);
  EXPECT_THROW(camera.SampleAs({200, -1}), Error);
}

TEST(CameraObserver, NoiseIsAFunctionOfTheSceneAndOfTheLook) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  CloudConfig config;
  config.noise.sensor = DepthSensor::kTimeOfFlight;
  OpeningExpert expert;
  const auto clouds = [&](const CloudConfig& used) {
    CameraObserver camera(scene, door, robot, used);
    std::vector<std::vector<float>> all;
    for (const Decision& decision : RunEpisode(scene, door, robot, expert, &camera).decisions)
      all.push_back(decision.cloud.xyz);
    return all;
  };
  EXPECT_EQ(clouds(config), clouds(config));
  EXPECT_NE(clouds(config), clouds({}));
}

TEST(CameraObserver, RefusesACameraInsideTheDoorByName) {
  const DoorAsset door = MakePrimitiveDoor({});
  const RobotModel robot = LoadMobileFranka();
  Scene scene = SampleScene(door, 1, 0);
  EXPECT_NO_THROW(CameraObserver(scene, door, robot));
  const RigidTransform leaf = scene.world_from_door * DoorFromLinks(door, 0, 0)[kLeafLink];
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : door.links[kLeafLink].geometry.at(0).hulls.at(0).vertices)
    box.extend(vertex);
  scene.camera.position_m = leaf * box.center();
  try {
    CameraObserver(scene, door, robot);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_NE(std::string(error.what()).find("inside the leaf"), std::string::npos) << error.what();
  }
}

TEST(RunEpisode, RefusesADoorWithoutAHinge) {
  DoorAsset door = MakePrimitiveDoor({});
  door.hinge.upper_rad = door.hinge.lower_rad;
  try {
    SampleScene(door, 1, 0);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_NE(std::string(error.what()).find("has no hinge"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace doorforge
