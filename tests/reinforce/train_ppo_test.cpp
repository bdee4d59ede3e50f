// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/train_ppo.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/settings_schema.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/policy/frozen_sight.h"
#include "doorforge/policy/hand_network.h"
#include "doorforge/reinforce/ppo_files.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/hand_stepper.h"
#include "doorforge/schemas/safetensors.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// What a training leaves that must not depend on how it was carried out.
constexpr const char* kFiles[] = {
    "policy.json",   "policy.safetensors", "training.safetensors",         "losses.jsonl",
    "training.html", "config.yaml",        "events.out.tfevents.doorforge"};

class TrainPpoTest : public testing::Test {
 protected:
  TrainPpoTest()
      : folder_(fs::temp_directory_path() / ("train_ppo_test_" + std::to_string(::getpid()))) {
    for (const char* name : {"one", "two"}) {
      const bool lever = name == std::string("two");
      DoorAsset door =
          MakePrimitiveDoor(RandomPrimitive(lever ? Mechanism::kLever : Mechanism::kNone, 23, 0));
      door.id = name;
      door.body = {.id = std::string("body_") + name, .sha256 = name};
      door.handle = {.id = std::string("handle_") + name, .sha256 = name};
      WriteDoor(door, folder_ / "doors" / name);
    }
  }
  ~TrainPpoTest() override { fs::remove_all(folder_); }

  PpoTrainingRequest Request(const std::string& out) const {
    PpoTrainingRequest request;
    request.doors = {(folder_ / "doors").string()};
    request.out = folder_ / out;
    request.threads = 1;
    request.config.scene.physics.base = RobotBase::kFloating;
    request.config.task.max_actions = 8;
    request.config.ppo.decisions = 72;
    request.config.ppo.steppers = 3;
    request.config.ppo.steps = 12;
    request.config.ppo.minibatch = 16;
    request.config.ppo.hidden = 8;
    return request;
  }

  void ExpectSameFiles(const std::string& a, const std::string& b) const {
    for (const char* file : kFiles)
      EXPECT_EQ(ReadFile(folder_ / a / file), ReadFile(folder_ / b / file)) << file;
  }

  static void ExpectRefused(const PpoTrainingRequest& request, ErrorCode code,
                            const std::string& word) {
    try {
      TrainPpoIntoFolder(request);
      ADD_FAILURE() << "not refused: " << word;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }

  fs::path folder_;
};

TEST_F(TrainPpoTest, LeavesTheSameBytesForAnyNumberOfThreads) {
  const PpoTrainingOutcome outcome = TrainPpoIntoFolder(Request("one_thread"));
  EXPECT_TRUE(outcome.finished());
  EXPECT_EQ(outcome.doors, 2U);
  PpoTrainingRequest two = Request("two_threads");
  two.threads = 2;
  TrainPpoIntoFolder(two);
  ExpectSameFiles("one_thread", "two_threads");
  const HandPolicyRecord policy = ReadHandPolicy(folder_ / "one_thread");
  EXPECT_EQ(policy.provenance.decisions, 72U);
  EXPECT_EQ(policy.provenance.trained_on.bodies.size(), 2U);
  EXPECT_NE(ReadFile(folder_ / "one_thread" / "losses.jsonl").find("{\"update\": 2"),
            std::string::npos);
}

// A kill behind the first update leaves the state of then in the folder.
TEST_F(TrainPpoTest, GoesOnWhereAKillLeftIt) {
  TrainPpoIntoFolder(Request("whole"));
  PpoTrainingRequest request = Request("parts");
  const PpoConfig& config = request.config.ppo;
  const auto doors = FindDoorSet({.folders = {folder_ / "doors"}}, 1).doors;
  const PpoTask task = DoorTask(doors, request.config);
  PpoState first;
  PpoHooks hooks{.threads = 1};
  hooks.on_update = [&](const PpoState& state) { first = state; };
  hooks.stop = [&] { return first.updates.size() == 1; };
  TrainPpo(task, config, InitialPpoState(task, config), hooks);
  ASSERT_EQ(first.updates.size(), 1U);

  // the origin that the whole training wrote
  const TensorFile written = ReadTensors(folder_ / "whole" / "training.safetensors");
  const PpoOrigin origin{written.metadata.at("config"), written.metadata.at("doors_sha256")};
  WritePpoState(request.out, first, origin);
  request.resume = true;
  EXPECT_TRUE(TrainPpoIntoFolder(request).finished());
  ExpectSameFiles("whole", "parts");
}

TEST_F(TrainPpoTest, TouchesAFolderWithATrainingOnlyWhereItWasTold) {
  TrainPpoIntoFolder(Request("out"));
  PpoTrainingRequest again = Request("out");
  ExpectRefused(again, ErrorCode::kInvalidArgument, "holds a training already");
  again.resume = true;
  EXPECT_TRUE(TrainPpoIntoFolder(again).finished());  // nothing is left to do
  again.config.ppo.seed = 8;
  ExpectRefused(again, ErrorCode::kInvalidArgument, "seed: recorded 7, given 8");
  again = Request("out");
  again.resume = true;
  again.doors = {(folder_ / "doors" / "one").string()};
  ExpectRefused(again, ErrorCode::kInvalidArgument, "other doors than --doors");
  std::ofstream(folder_ / "out" / "training.safetensors", std::ios::app) << "x";
  again = Request("out");
  again.resume = true;
  ExpectRefused(again, ErrorCode::kFormat, "training.safetensors");
  again.resume = false;
  again.overwrite = true;
  EXPECT_TRUE(TrainPpoIntoFolder(again).finished());
}

// ---- acting on the features of a network that looks ---------------------------------------------

class TrainOnFeaturesTest : public TrainPpoTest {
 protected:
  TrainOnFeaturesTest() { WriteEyes("eyes", 3); }

  void WriteEyes(const std::string& name, std::uint64_t seed) const {
    SightPolicyRecord eyes;
    eyes.shape = SightShape({.point_hidden = 8,
                             .point_features = 32,
                             .cloud_hidden = 8,
                             .cloud_features = 8,
                             .hidden = 8,
                             .last_hidden = 8});
    eyes.parameters = PointNetInitialisation(eyes.shape, seed, "test.");
    eyes.look.points = 32;
    eyes.provenance = {"dagger", "0.0", "{}", 1, {{{"body_eyes", "e"}}, {}}};
    WriteSightPolicy(folder_ / name, eyes);
  }

  PpoTrainingRequest OnFeatures(const std::string& out) const {
    PpoTrainingRequest request = Request(out);
    request.config.scene.camera.width = request.config.scene.camera.height = 48;
    request.features = folder_ / "eyes";
    return request;
  }
};

// What the camera of the scene sees, the hand in it, in the numbers of the network.
TEST_F(TrainOnFeaturesTest, ObservesWhatTheCameraSees) {
  const HandTrainingConfig config = OnFeatures("none").config;
  const auto doors = FindDoorSet({.folders = {folder_ / "doors"}}, 1).doors;
  const SightPolicyRecord eyes = ReadSightPolicy(folder_ / "eyes");
  const auto sight = std::make_shared<FrozenSight>(eyes.shape, eyes.parameters, eyes.look);
  const PpoTask task = DoorTask(doors, config, sight);
  EXPECT_EQ(task.observation_size, 8 + kSightOwn);
  const auto stepper = task.make();
  const std::vector<float> first = stepper->Reset(5);
  const std::vector<float> next =
      stepper->Step(std::vector<float>{1, 0, 0, 0, 0, 0, 0}).observation;
  // by hand; which door episode 5 draws is told by which of the two gives the same
  const RobotModel robot = LoadRobot({}, RobotBase::kFloating);
  int same = 0;
  for (const char* name : {"one", "two"}) {
    const auto one = FindDoorSet({.folders = {folder_ / "doors" / name}}, 1).doors;
    DoorCache cache(one);
    const IdentifiedDoor door = cache.Take(0);
    const Scene scene =
        PlaceRobotBase(robot, SampleScene(door, config.ppo.seed, 5, config.scene), *door);
    CameraObserver camera(scene, *door, robot, config.cloud);
    camera.SampleAs({32, eyes.look.crop_radius_m});
    HandStepper by_hand(*door, robot, config.task);
    by_hand.Reset(scene, &camera);
    if (sight->NumbersOf(by_hand.now().state, by_hand.Look()) != first) continue;
    ++same;
    const std::vector<float> action = {1, 0, 0, 0, 0, 0, 0};
    by_hand.Step(HandCommandOf(action, by_hand.now().state, config.task));
    EXPECT_EQ(sight->NumbersOf(by_hand.now().state, by_hand.Look()), next);
  }
  EXPECT_EQ(same, 1);
}

TEST_F(TrainOnFeaturesTest, LeavesTheSameBytesForAnyNumberOfThreadsAndAPolicyThatLooks) {
  EXPECT_TRUE(TrainPpoIntoFolder(OnFeatures("one_thread")).finished());
  PpoTrainingRequest two = OnFeatures("two_threads");
  two.threads = 2;
  TrainPpoIntoFolder(two);
  ExpectSameFiles("one_thread", "two_threads");
  const FrozenPolicyRecord policy = ReadFrozenPolicy(folder_ / "one_thread");
  const SightPolicyRecord eyes = ReadSightPolicy(folder_ / "eyes");
  EXPECT_EQ(policy.sight, eyes.parameters);  // they have not learned
  EXPECT_EQ(policy.provenance.teacher_sha256, eyes.weights_sha256);
  EXPECT_EQ(policy.provenance.trained_on.bodies.size(), 3U);  // those of the eyes, too
}

TEST_F(TrainOnFeaturesTest, SaysWhatIsWrongWithFeatures) {
  PpoTrainingRequest request = OnFeatures("out");
  request.features = folder_ / "nowhere";
  ExpectRefused(request, ErrorCode::kMissing, "no such folder");
  TrainPpoIntoFolder(Request("states"));
  request.features = folder_ / "states";
  ExpectRefused(request, ErrorCode::kFormat, "a policy of true states");
  TrainPpoIntoFolder(OnFeatures("out"));
  WriteEyes("eyes", 4);
  request = OnFeatures("out");
  request.resume = true;
  ExpectRefused(request, ErrorCode::kInvalidArgument, "weights_sha256");
  request.features.clear();
  ExpectRefused(request, ErrorCode::kInvalidArgument, "features");
}

// After settings were changed on purpose:
//   DOORFORGE_WRITE_SCHEMAS=1 build/dev/bin/reinforce_test --gtest_filter=HandTraining*
TEST(HandTrainingConfig, IsPublishedAsASchema) {
  const auto schema = SettingsSchema<HandTrainingConfig>("Settings of `doorforge reinforce`");
  const fs::path path = DOORFORGE_SOURCE_DIR "/schemas/json/settings_reinforce.schema.json";
  if (std::getenv("DOORFORGE_WRITE_SCHEMAS") != nullptr) WriteJsonFile(path, schema);
  EXPECT_EQ(ReadFile(path), schema.dump(2) + "\n");
}

TEST_F(TrainPpoTest, RefusesWhatItCannotLearn) {
  PpoTrainingRequest request = Request("refused");
  request.config.scene.physics.base = RobotBase::kFixed;
  ExpectRefused(request, ErrorCode::kInvalidConfig, "scene.physics.base: fixed");
  request = Request("refused");
  request.doors = {(folder_ / "nowhere").string()};
  ExpectRefused(request, ErrorCode::kMissing, "nowhere");
  request = Request("refused");
  request.config.ppo.minibatch = 0;
  ExpectRefused(request, ErrorCode::kInvalidConfig, "config.ppo.minibatch");
  EXPECT_FALSE(fs::exists(folder_ / "refused"));
}

}  // namespace
}  // namespace doorforge
