// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// A policy that does all of an episode, among those of the registry.

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/policy/hand_network.h"
#include "doorforge/policy/hand_sight.h"
#include "doorforge/policy/trajectory_policy.h"
#include "doorforge/registry/policy_episodes.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/hand_stepper.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

class WholePolicyTest : public testing::Test {
 protected:
  WholePolicyTest()
      : folder_(fs::temp_directory_path() / ("whole_policy_test_" + std::to_string(::getpid()))) {
    record_.parameters = MlpInitialisation(record_.shape, 5, "test.", 1);
    record_.task.max_actions = 6;
    record_.provenance = {"ppo", "0.0", "{}", 1, {}};
    WriteHandPolicy(folder_, record_);
  }
  ~WholePolicyTest() override { fs::remove_all(folder_); }

  PolicyWords Words() const { return {.whole = folder_.string()}; }

  void ExpectRefused(const PolicyWords& words, ErrorCode code, const std::string& word) const {
    try {
      PolicySetFactory(BuiltInPolicies(), words).Make();
      ADD_FAILURE() << "not refused: " << word;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }

  fs::path folder_;
  HandPolicyRecord record_;
};

TEST_F(WholePolicyTest, PlaysTheEpisodeByItself) {
  const DoorAsset door = MakePrimitiveDoor({});
  const RobotModel robot = LoadRobot({}, RobotBase::kFloating);
  SceneConfig config;
  config.physics.base = RobotBase::kFloating;
  const Scene scene = SampleScene(door, 3, 0, config);
  HandNetworkPolicy policy(record_);
  const Episode expected = RunHandEpisode(scene, door, robot, policy, nullptr);
  const PolicySetFactory factory(BuiltInPolicies(), Words());
  EXPECT_FALSE(factory.IsExpertAlone());
  EXPECT_FALSE(UsesPointCloud(factory.Make()));
  PolicyEpisodes episodes(factory);
  const Episode found = episodes.Run({scene, door, robot}, nullptr);
  EXPECT_EQ(found.state_sha256, expected.state_sha256);
  EXPECT_EQ(found.detail, expected.detail);
}

// What a policy that looks is shown, and what it then does.
struct Looks {
  std::vector<LabelledCloud> clouds;
  Episode episode;
};

// An episode by hand: the camera of the scene, sampled as the policy asks.
Looks EpisodeByHand(const EpisodePlace& place, const SightPolicyRecord& record) {
  Looks looks;
  HandSightPolicy policy(record);
  CameraObserver camera(place.scene, place.door, place.robot, place.cloud);
  camera.SampleAs({record.look.points, record.look.crop_radius_m});
  HandStepper stepper(place.door, place.robot, record.task);
  stepper.Reset(place.scene, &camera);
  while (!stepper.now().over) {
    looks.clouds.push_back(stepper.Look());
    stepper.Step(policy.Act(stepper.now().state, looks.clouds.back()));
  }
  looks.episode = stepper.Summary();
  return looks;
}

TEST_F(WholePolicyTest, IsShownWhatTheCameraSeesWithTheHandInIt) {
  SightPolicyRecord student;
  student.parameters = PointNetInitialisation(student.shape, 5, "test.");
  student.task.max_actions = 6;
  student.look.points = 256;
  student.provenance = {"dagger", "0.0", "{}", 1, {}, "abc"};
  WriteSightPolicy(folder_, student);
  const DoorAsset door = MakePrimitiveDoor({});
  const RobotModel robot = LoadRobot({}, RobotBase::kFloating);
  SceneConfig config;
  config.physics.base = RobotBase::kFloating;
  const Scene scene = SampleScene(door, 3, 0, config);
  const Looks expected = EpisodeByHand({scene, door, robot}, student);
  ASSERT_EQ(expected.clouds.size(), 6U);
  for (const LabelledCloud& cloud : expected.clouds) {
    EXPECT_EQ(cloud.label.size(), 256U);
    EXPECT_GT(std::ranges::count(cloud.label, static_cast<std::uint8_t>(PointLabel::kRobot)), 10);
  }
  // it strays from the door, which it has before it at first
  EXPECT_GT(
      std::ranges::count(expected.clouds[0].label, static_cast<std::uint8_t>(PointLabel::kBody)),
      10);
  const PolicySetFactory factory(BuiltInPolicies(), Words());
  EXPECT_TRUE(UsesPointCloud(factory.Make()));
  PolicyEpisodes episodes(factory);
  const Episode found = episodes.Run({scene, door, robot}, nullptr);
  EXPECT_EQ(found.state_sha256, expected.episode.state_sha256);
  // without the hand in the picture it sees something else, and does
  const Episode other = episodes.Run({scene, door, robot, CloudConfig{.robot = false}}, nullptr);
  EXPECT_NE(found.state_sha256, other.state_sha256);
}

// One that says trajectories, on an arm: the grasp and the way are those that it says of the closed
// door, through a camera of its own.
TEST_F(WholePolicyTest, CarriesOutWhatItSaidOfTheClosedDoor) {
  TrajectoryPolicyRecord record;
  record.networks = InitialTrajectoryNetworks({.waypoints = 3}, 5);
  record.networks.posterior.clear();
  record.look.finer = 1;
  record.choice = {.contacts = 4, .proposals = 5};
  record.provenance = {"trajectories", "0.0", "{}", 1, {}};
  WriteTrajectoryPolicy(folder_, record);
  const DoorAsset door = MakePrimitiveDoor({});
  const RobotModel robot = LoadMobileFranka();
  const Scene scene = PlaceRobotBase(robot, SampleScene(door, 3, 0), door);
  TrajectoryPolicies policies = MakeTrajectoryPolicies(record);
  CameraObserver camera(scene, door, robot, {}, /*sees_robot=*/false);
  GraspFromPolicy chooser(*policies.grasp, scene, door, robot, [&](const SceneSnapshot& snapshot) {
    return camera.Render(snapshot).visible;
  });
  const Episode expected = RunStages(
      scene, door, robot,
      {.grasp = &chooser, .handle = policies.handle.get(), .open = policies.open.get()}, nullptr);
  const PolicySetFactory factory(BuiltInPolicies(), Words());
  EXPECT_FALSE(factory.IsExpertAlone());
  EXPECT_FALSE(UsesPointCloud(factory.Make()));
  PolicyEpisodes episodes(factory);
  const Episode found = episodes.Run({scene, door, robot}, nullptr);
  EXPECT_EQ(found.state_sha256, expected.state_sha256);
  EXPECT_EQ(found.detail, expected.detail);
  EXPECT_EQ(episodes.Run({scene, door, robot}, nullptr).state_sha256, found.state_sha256);
}

TEST_F(WholePolicyTest, SaysWhatIsWrong) {
  ExpectRefused({.whole = (folder_ / "nowhere").string()}, ErrorCode::kMissing, "no such folder");
  PolicyWords words = Words();
  words.grasper = "random";
  ExpectRefused(words, ErrorCode::kInvalidArgument, "leave \"random\" out");
  ExpectRefused({.opener = folder_.string()}, ErrorCode::kFormat, "of the stage \"whole\"");
  ExpectRefused({.whole = DOORFORGE_SOURCE_DIR "/data/policies/opener"}, ErrorCode::kFormat,
                "`doorforge reinforce` makes such");
  fs::remove(folder_ / "policy.safetensors");
  ExpectRefused(Words(), ErrorCode::kMissing, "policy.safetensors");
}

// The hand of an arm does not fly.
TEST_F(WholePolicyTest, NeedsAHandThatFlies) {
  const DoorAsset door = MakePrimitiveDoor({});
  const RobotModel robot = LoadMobileFranka();
  const Scene scene = SampleScene(door, 3, 0);
  PolicyEpisodes episodes(PolicySetFactory(BuiltInPolicies(), Words()));
  try {
    episodes.Run({scene, door, robot}, nullptr);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidConfig);
    EXPECT_NE(std::string(error.what()).find("--preset doorgym"), std::string::npos);
  }
}

}  // namespace
}  // namespace doorforge
