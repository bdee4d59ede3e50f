// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/train_trajectories.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/settings_schema.h"
#include "doorforge/reinforce/trajectory_files.h"
#include "doorforge/schemas/safetensors.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// What a training leaves that must not depend on how it was carried out.
constexpr const char* kLeft[] = {"policy.json",   "policy.safetensors",
                                 "losses.jsonl",  "training.safetensors",
                                 "training.html", "samples/round_0000.safetensors",
                                 "config.yaml",   "samples/round_0001.safetensors"};

TrajectoryTrainingConfig SmallTraining() {
  TrajectoryTrainingConfig config;
  config.scene.camera.width = config.scene.camera.height = 128;
  config.grasp = {.near_share = 1, .near_turn_rad = 0, .tilt_rad = 0, .beside_share = 0};
  config.look = {.near_points = 20, .far_points = 12, .near_m = 0.2, .finer = 1};
  config.network = {.waypoints = 4,
                    .latent = 3,
                    .point_hidden = 8,
                    .point_features = 32,
                    .cloud_hidden = 8,
                    .cloud_features = 8,
                    .hidden = 8,
                    .last_hidden = 8};
  config.learning.rounds = 2;
  config.learning.episodes = 4;
  config.learning.minibatches = 2;
  config.learning.minibatch = 20;
  config.learning.rated_proposals = 3;
  return config;
}

class TrainTrajectoriesTest : public ::testing::Test {
 protected:
  TrainTrajectoriesTest()
      : folder_(fs::temp_directory_path() / ("train_ways_test_" + std::to_string(::getpid()))) {
    DoorAsset door = MakePrimitiveDoor({.mechanism = Mechanism::kNone});
    door.id = "one";
    door.body = {.id = "body_one", .sha256 = "b"};
    door.handle = {.id = "handle_one", .sha256 = "h"};
    WriteDoor(door, folder_ / "doors" / "one");
  }
  ~TrainTrajectoriesTest() override { fs::remove_all(folder_); }

  TrajectoryTrainingRequest Training(const std::string& out) const {
    TrajectoryTrainingRequest request;
    request.doors = {(folder_ / "doors").string()};
    request.out = folder_ / out;
    request.threads = 1;
    request.config = SmallTraining();
    return request;
  }

  std::vector<FoundDoor> Doors() const {
    return FindDoorSet({.folders = {folder_ / "doors"}}, 1).doors;
  }

  void ExpectSameFolders(const std::string& a, const std::string& b) const {
    for (const char* file : kLeft)
      EXPECT_EQ(ReadFile(folder_ / a / file), ReadFile(folder_ / b / file)) << file;
  }

  static void ExpectRefused(const TrajectoryTrainingRequest& request, ErrorCode code,
                            const std::string& word) {
    try {
      TrainTrajectoriesIntoFolder(request);
      ADD_FAILURE() << "not refused: " << word;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }

  fs::path folder_;
};

// The rules' trajectory of a door without a latch is an arc: all its waypoints are as far from the
// hinge's axis as the first.
TEST_F(TrainTrajectoriesTest, RulesTeachTheWayOfADoor) {
  const std::vector<FoundDoor> doors = Doors();
  const TrajectoryTask task = TrajectoryLessons(doors, SmallTraining());
  const auto trial = task.play(0, nullptr);
  ASSERT_TRUE(trial);
  EXPECT_TRUE(trial->opened);
  EXPECT_TRUE(trial->moved);
  EXPECT_GT(trial->opening_rad, 0.9F);
  EXPECT_EQ(trial->sight.label.size(), 32U);
  ASSERT_EQ(trial->numbers.size(), static_cast<std::size_t>(TrajectoryNumbers(4)));
  const HandTrajectory way = TrajectoryFromNumbers(trial->numbers);
  // a hand that went round the axis has moved by the chord of its turn
  for (const HandWaypoint& waypoint : way.waypoints) {
    const double turn = waypoint.turn_rad.norm();
    const double last_turn = way.waypoints.back().turn_rad.norm();
    const double reach = way.waypoints.back().offset_m.norm() / (2 * std::sin(last_turn / 2));
    EXPECT_NEAR(waypoint.offset_m.norm(), 2 * reach * std::sin(turn / 2), 0.02);
    EXPECT_GT(reach, 0.3);
  }
  // once more, and by who has learned nothing
  const auto again = task.play(0, nullptr);
  EXPECT_EQ(again->numbers, trial->numbers);
  const TrajectoryState nobody = InitialTrajectoryState(SmallTraining().network, 3);
  const TrajectoryRater rater(nobody.Networks());
  const auto tried = task.play(0, &rater);
  ASSERT_TRUE(tried);
  EXPECT_EQ(tried->sight.xyz, trial->sight.xyz);
  EXPECT_NE(tried->numbers, trial->numbers);
}

TEST_F(TrainTrajectoriesTest, LeavesTheSameBytesForAnyNumberOfThreadsAndAfterAKill) {
  EXPECT_TRUE(TrainTrajectoriesIntoFolder(Training("one_thread")).finished());
  TrajectoryTrainingRequest two = Training("two_threads");
  two.threads = 2;
  TrainTrajectoriesIntoFolder(two);
  ExpectSameFolders("one_thread", "two_threads");
  const TrajectoryPolicyRecord policy = ReadTrajectoryPolicy(folder_ / "one_thread");
  EXPECT_EQ(policy.provenance.decisions, 8U);
  EXPECT_EQ(policy.provenance.method, kTrajectoryMethod);
  EXPECT_EQ(policy.provenance.trained_on.bodies.size(), 1U);
  EXPECT_EQ(policy.networks.shape, SmallTraining().network);

  // A kill behind the first round, in the middle of the second: its samples are there, its state is
  // not.
  const TensorFile written = ReadTensors(folder_ / "one_thread" / "training.safetensors");
  const PpoOrigin origin{written.metadata.at("config"), written.metadata.at("doors_sha256")};
  TrajectoryTrainingRequest request = Training("parts");
  TrajectoryProgress first;
  TrajectoryHooks hooks{.threads = 1};
  hooks.on_round = [&](const TrajectoryState& state, const TrajectorySamples& fresh) {
    first = {state, {WriteTrajectorySamples(request.out, 0, fresh)}};
  };
  hooks.stop = [&] { return !first.samples_sha256.empty(); };
  const TrajectoryTrainingConfig config = SmallTraining();
  const std::vector<FoundDoor> doors = Doors();
  const TrajectoryTask task = TrajectoryLessons(doors, config);
  TrainTrajectories(task, config.learning,
                    InitialTrajectoryState(config.network, config.learning.seed), {}, hooks);
  ASSERT_EQ(first.state.rounds.size(), 1U);
  WriteTrajectoryState(request.out, first, origin);
  std::ofstream(request.out / "samples" / "round_0001.safetensors") << "half";
  request.resume = true;
  EXPECT_TRUE(TrainTrajectoriesIntoFolder(request).finished());
  ExpectSameFolders("one_thread", "parts");
}

TEST_F(TrainTrajectoriesTest, TouchesAFolderWithATrainingOnlyWhereItWasTold) {
  TrainTrajectoriesIntoFolder(Training("out"));
  TrajectoryTrainingRequest again = Training("out");
  ExpectRefused(again, ErrorCode::kInvalidArgument, "holds a training already");
  again.resume = true;
  EXPECT_TRUE(TrainTrajectoriesIntoFolder(again).finished());  // nothing is left to do
  again.config.look.near_points = 33;
  ExpectRefused(again, ErrorCode::kInvalidArgument, "near_points: recorded 20, given 33");
  again = Training("out");
  again.resume = true;
  std::ofstream(folder_ / "out" / "samples" / "round_0001.safetensors", std::ios::app) << "x";
  ExpectRefused(again, ErrorCode::kFormat, "round_0001.safetensors: damaged");
  again.resume = false;
  again.overwrite = true;
  EXPECT_TRUE(TrainTrajectoriesIntoFolder(again).finished());
}

TEST_F(TrainTrajectoriesTest, RefusesWhatItCannotLearn) {
  TrajectoryTrainingRequest request = Training("refused");
  request.config.scene.physics.base = RobotBase::kFloating;
  ExpectRefused(request, ErrorCode::kInvalidConfig, "scene.physics.base");
  request = Training("refused");
  request.config.choice.actions = 0;
  ExpectRefused(request, ErrorCode::kInvalidConfig, "config.choice.actions");
  request = Training("refused");
  request.config.learning.minibatch = 0;
  ExpectRefused(request, ErrorCode::kInvalidConfig, "config.learning.minibatch");
  EXPECT_FALSE(fs::exists(folder_ / "refused" / "policy.json"));
}

// After settings were changed on purpose:
//   DOORFORGE_WRITE_SCHEMAS=1 build/dev/bin/reinforce_test --gtest_filter=Trajector*
TEST(TrajectoryTrainingConfig, IsPublishedAsASchema) {
  const auto schema =
      SettingsSchema<TrajectoryTrainingConfig>("Settings of `doorforge reinforce --trajectories`");
  const fs::path path = DOORFORGE_SOURCE_DIR "/schemas/json/settings_trajectories.schema.json";
  if (std::getenv("DOORFORGE_WRITE_SCHEMAS") != nullptr) WriteJsonFile(path, schema);
  EXPECT_EQ(ReadFile(path), schema.dump(2) + "\n");
}

}  // namespace
}  // namespace doorforge
