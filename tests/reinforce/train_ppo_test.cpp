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
#include "doorforge/policy/hand_network.h"
#include "doorforge/reinforce/ppo_files.h"
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
