// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/train_distil.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/settings_schema.h"
#include "doorforge/policy/hand_sight.h"
#include "doorforge/reinforce/distil_files.h"
#include "doorforge/reinforce/reinforce.h"
#include "doorforge/schemas/safetensors.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// What a training leaves that must not depend on how it was carried out.
constexpr const char* kDistilled[] = {"policy.json",   "policy.safetensors",
                                      "losses.jsonl",  "training.safetensors",
                                      "training.html", "samples/round_0000.safetensors",
                                      "config.yaml",   "samples/round_0001.safetensors"};

class TrainDistilTest : public testing::Test {
 protected:
  TrainDistilTest()
      : folder_(fs::temp_directory_path() / ("train_distil_test_" + std::to_string(::getpid()))) {
    DoorAsset door = MakePrimitiveDoor(RandomPrimitive(Mechanism::kNone, 23, 0));
    door.id = "one";
    door.body = {.id = "body_one", .sha256 = "b"};
    door.handle = {.id = "handle_one", .sha256 = "h"};
    WriteDoor(door, folder_ / "doors" / "one");
    WriteTeacher(FlyingConfig().scene);
  }
  ~TrainDistilTest() override { fs::remove_all(folder_); }

  static DistilConfig FlyingConfig() {
    DistilConfig config;
    config.scene.physics.base = RobotBase::kFloating;
    config.scene.camera.width = config.scene.camera.height = 48;
    config.look.points = 32;
    config.dagger.rounds = 2;
    config.dagger.episodes = 3;
    config.dagger.cloning_minibatches = config.dagger.minibatches = 3;
    config.dagger.minibatch = 20;
    config.dagger.point_hidden = 8;
    config.dagger.point_features = 32;
    config.dagger.cloud_hidden = config.dagger.cloud_features = 8;
    config.dagger.hidden = config.dagger.last_hidden = 8;
    return config;
  }

  void WriteTeacher(const SceneConfig& scene) const {
    HandPolicyRecord teacher;
    teacher.shape.hidden = 8;
    teacher.parameters = MlpInitialisation(teacher.shape, 3, "test.", 1);
    teacher.task.max_actions = 5;
    nlohmann::ordered_json config;
    config["scene"] = ToJson(scene);
    teacher.provenance = {"ppo", "0.0", JsonText(config), 1, {{{"body_two", "2"}}, {}}};
    WriteHandPolicy(folder_ / "teacher", teacher);
  }

  DistilRequest Lesson(const std::string& out) const {
    DistilRequest request;
    request.doors = {(folder_ / "doors").string()};
    request.out = folder_ / out;
    request.threads = 1;
    request.teacher = folder_ / "teacher";
    request.config = FlyingConfig();
    return request;
  }

  void ExpectSameFolders(const std::string& a, const std::string& b) const {
    for (const char* file : kDistilled)
      EXPECT_EQ(ReadFile(folder_ / a / file), ReadFile(folder_ / b / file)) << file;
  }

  static void ExpectRefusal(const DistilRequest& request, ErrorCode code, const std::string& word) {
    try {
      DistilIntoFolder(request);
      ADD_FAILURE() << "not refused: " << word;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }

  fs::path folder_;
};

TEST_F(TrainDistilTest, LeavesTheSameBytesForAnyNumberOfThreadsAndAfterAKill) {
  const DistilOutcome outcome = DistilIntoFolder(Lesson("one_thread"));
  EXPECT_TRUE(outcome.finished());
  DistilRequest two = Lesson("two_threads");
  two.threads = 2;
  DistilIntoFolder(two);
  ExpectSameFolders("one_thread", "two_threads");
  const SightPolicyRecord policy = ReadSightPolicy(folder_ / "one_thread");
  EXPECT_EQ(policy.provenance.decisions, 2U * 3 * 5);
  EXPECT_EQ(policy.provenance.method, kDistilMethod);
  EXPECT_EQ(policy.provenance.trained_on.bodies.size(), 2U);  // the teacher's, too
  EXPECT_EQ(policy.provenance.teacher_sha256, ReadHandPolicy(folder_ / "teacher").weights_sha256);
  EXPECT_EQ(policy.task.max_actions, 5);

  // A kill behind the first round, in the middle of the second: its samples are there, its state is
  // not.
  const TensorFile written = ReadTensors(folder_ / "one_thread" / "training.safetensors");
  const PpoOrigin origin{written.metadata.at("config"), written.metadata.at("doors_sha256")};
  DistilRequest request = Lesson("parts");
  const auto doors = FindDoorSet({.folders = {folder_ / "doors"}}, 1).doors;
  const DaggerTask task = DistilTask(doors, ReadHandPolicy(folder_ / "teacher"), request.config);
  DistilProgress first;
  DaggerHooks hooks{.threads = 1};
  hooks.on_round = [&](const DaggerState& state, const DaggerSamples& fresh) {
    first = {state, {WriteDistilSamples(request.out, 0, fresh)}};
  };
  hooks.stop = [&] { return !first.samples_sha256.empty(); };
  const DaggerConfig& config = request.config.dagger;
  TrainDagger(task, config, InitialDaggerState(config), {.points = task.points}, hooks);
  ASSERT_EQ(first.state.rounds.size(), 1U);
  WriteDistilState(request.out, first, origin);
  std::ofstream(request.out / "samples" / "round_0001.safetensors") << "half";
  request.resume = true;
  EXPECT_TRUE(DistilIntoFolder(request).finished());
  ExpectSameFolders("one_thread", "parts");
}

TEST_F(TrainDistilTest, TouchesAFolderWithATrainingOnlyWhereItWasTold) {
  DistilIntoFolder(Lesson("out"));
  DistilRequest again = Lesson("out");
  ExpectRefusal(again, ErrorCode::kInvalidArgument, "holds a training already");
  again.resume = true;
  EXPECT_TRUE(DistilIntoFolder(again).finished());  // nothing is left to do
  again.config.look.points = 33;
  ExpectRefusal(again, ErrorCode::kInvalidArgument, "points: recorded 32, given 33");
  again = Lesson("out");
  again.resume = true;
  std::ofstream(folder_ / "out" / "samples" / "round_0001.safetensors", std::ios::app) << "x";
  ExpectRefusal(again, ErrorCode::kFormat, "round_0001.safetensors: damaged");
  fs::remove(folder_ / "out" / "samples" / "round_0001.safetensors");
  ExpectRefusal(again, ErrorCode::kMissing, "round_0001.safetensors");
  std::ofstream(folder_ / "out" / "training.safetensors", std::ios::app) << "x";
  ExpectRefusal(again, ErrorCode::kFormat, "training.safetensors");
  again.resume = false;
  again.overwrite = true;
  EXPECT_TRUE(DistilIntoFolder(again).finished());
  again.overwrite = false;
  again.resume = true;
  again.config.scene.physics.base = RobotBase::kFloating;
  WriteTeacher(SceneConfig{again.config.scene});  // the same again
  EXPECT_TRUE(DistilIntoFolder(again).finished());
}

TEST_F(TrainDistilTest, SaysWhatIsWrongWithATeacher) {
  DistilRequest request = Lesson("refused");
  request.teacher = folder_ / "nowhere";
  ExpectRefusal(request, ErrorCode::kMissing, "no such folder");
  request.teacher = folder_ / "doors";
  ExpectRefusal(request, ErrorCode::kMissing, "policy.json");
  request.teacher = DOORFORGE_SOURCE_DIR "/data/policies/opener";
  ExpectRefusal(request, ErrorCode::kFormat, "a policy of the stage \"open\"");
  DistilIntoFolder(Lesson("student"));
  request.teacher = folder_ / "student";
  ExpectRefusal(request, ErrorCode::kFormat, "a policy that looks");

  request = Lesson("refused");
  request.config.scene.physics.finger_friction = 0.9;
  ExpectRefusal(request, ErrorCode::kInvalidArgument, "was trained in another environment");
  ExpectRefusal(request, ErrorCode::kInvalidArgument, "finger_friction");
  request = Lesson("refused");
  request.config.scene.camera.width = 32;             // it never looked,
  request.config.scene.episode.open_angle_rad = 0.3;  // and was never told what counts
  request.config.scene.episode.grip_needed = 0;
  request.config.scene.physics.finish_hinge_rad = 0.3;
  request.config.dagger.rounds = 1;
  EXPECT_TRUE(DistilIntoFolder(request).finished());
}

TEST_F(TrainDistilTest, RefusesWhatItCannotLearn) {
  SceneConfig fixed;
  fixed.physics.base = RobotBase::kFixed;
  WriteTeacher(fixed);
  DistilRequest request = Lesson("refused");
  request.config.scene = fixed;
  ExpectRefusal(request, ErrorCode::kInvalidConfig, "scene.physics.base: fixed");
  request = Lesson("refused");
  request.config.dagger.minibatch = 0;
  ExpectRefusal(request, ErrorCode::kInvalidConfig, "config.dagger.minibatch");
  WriteTeacher(FlyingConfig().scene);
  request = Lesson("refused");
  request.config.look.points = 1;
  ExpectRefusal(request, ErrorCode::kInvalidConfig, "config.look.points");
  EXPECT_FALSE(fs::exists(folder_ / "refused" / "policy.json"));
}

TEST_F(TrainDistilTest, HasOptionsOfItsOwn) {
  ReinforceRequest request;
  request.rounds = 3;
  EXPECT_THROW(Reinforce(request, {}), Error);
  request = {};
  request.teacher = folder_ / "teacher";
  request.decisions = 3;
  EXPECT_THROW(Reinforce(request, {}), Error);
  request.decisions.reset();
  request.features = folder_ / "teacher";
  EXPECT_THROW(Reinforce(request, {}), Error);
  request.features.clear();
  request.trajectories = true;
  EXPECT_THROW(Reinforce(request, {}), Error);
  request.teacher.clear();
  request.decisions = 3;
  EXPECT_THROW(Reinforce(request, {}), Error);
}

// After settings were changed on purpose:
//   DOORFORGE_WRITE_SCHEMAS=1 build/dev/bin/reinforce_test --gtest_filter=Distil*
TEST(DistilConfig, IsPublishedAsASchema) {
  const auto schema = SettingsSchema<DistilConfig>("Settings of `doorforge reinforce --teacher`");
  const fs::path path = DOORFORGE_SOURCE_DIR "/schemas/json/settings_distil.schema.json";
  if (std::getenv("DOORFORGE_WRITE_SCHEMAS") != nullptr) WriteJsonFile(path, schema);
  EXPECT_EQ(ReadFile(path), schema.dump(2) + "\n");
}

}  // namespace
}  // namespace doorforge
