// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/registry/policy_episodes.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "doorforge/core/error.h"
#include "doorforge/schemas/door_asset.h"

#include "../physics/primitive_door.h"
#include "../program_answer.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

const std::string kShipped = DOORFORGE_SOURCE_DIR "/data/policies/";

class PolicyEpisodesTest : public testing::Test {
 protected:
  PolicyEpisodesTest()
      : folder_(fs::temp_directory_path() /
                ("policy_episodes_test_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_ / "door");
    DoorAsset door = MakePrimitiveDoor({});
    door.body = {.id = "body", .sha256 = "body"};
    door.handle = {.id = "handle", .sha256 = "handle"};
    WriteDoor(door, folder_ / "door");
  }
  ~PolicyEpisodesTest() override { fs::remove_all(folder_); }

  std::string StateAfter(const PolicyWords& words) const {
    SimulationRun run;
    run.doors = {folder_};
    run.threads = 1;
    PolicySimulateConfig config;
    config.scene.physics.max_opening_actions = 4;
    return SimulateDoorsWith(words, config, run).at(0).episode.state_sha256;
  }

  fs::path folder_;
};

TEST_F(PolicyEpisodesTest, TheExpertIsSimulatedAsBeforeAndOthersByTheirWords) {
  SimulationRun run;
  run.doors = {folder_};
  run.threads = 1;
  run.config.scene.physics.max_opening_actions = 4;
  const std::string expert = SimulateDoors(run).at(0).episode.state_sha256;
  EXPECT_EQ(StateAfter({}), expert);
  EXPECT_NE(StateAfter({.opener = kShipped + "opener"}), expert);
  EXPECT_NE(StateAfter({.handler = kShipped + "handler"}), expert);
  EXPECT_NE(StateAfter({.grasper = "random"}), expert);
}

TEST_F(PolicyEpisodesTest, TrainedPoliciesHaveTheirSettings) {
  SimulationRun run;
  run.doors = {folder_};
  run.threads = 1;
  PolicySimulateConfig config;
  config.scene.physics.max_opening_actions = 4;
  const PolicyWords words{.opener = kShipped + "opener"};
  const auto state = [&] {
    return SimulateDoorsWith(words, config, run).at(0).episode.state_sha256;
  };
  const std::string told_left = state();
  config.policy.told.side = SideChoice::kRight;
  EXPECT_NE(state(), told_left);
}

TEST_F(PolicyEpisodesTest, WhoLooksOnChangesNothing) {
  class Counting : public Observer {
   public:
    LabelledCloud Observe(const SceneSnapshot&) override {
      ++looks;
      return {};
    }
    int looks = 0;
  };
  const DoorAsset door = MakePrimitiveDoor({});
  const RobotModel robot = LoadMobileFranka();
  SceneConfig config;
  config.physics.max_opening_actions = 3;
  const Scene scene = SampleScene(door, 5, 0, config);
  PolicyEpisodes episodes(PolicySetFactory(BuiltInPolicies(), {.opener = kShipped + "opener"}));
  Counting watcher;
  EXPECT_EQ(episodes.Run({scene, door, robot}, &watcher).state_sha256,
            episodes.Run({scene, door, robot}, nullptr).state_sha256);
  EXPECT_GT(watcher.looks, 0);
}

TEST_F(PolicyEpisodesTest, ARobotWhoseStateNoPolicyKnowsIsForTheExpert) {
  SimulationRun run;
  run.doors = {folder_};
  run.threads = 1;
  PolicySimulateConfig config;
  config.scene.physics.base = RobotBase::kYaw;
  EXPECT_NO_THROW(SimulateDoorsWith({}, config, run));
  EXPECT_THROW(SimulateDoorsWith({.opener = kShipped + "opener"}, config, run), Error);
}

TEST_F(PolicyEpisodesTest, TheProgramTakesTheSameWords) {
  const std::string simulate = DOORFORGE_BINARY_DIR "/bin/doorforge-simulate simulate --door " +
                               folder_.string() + " --set scene.physics.max_opening_actions=4 ";
  const auto state_of = [&](const std::string& words) {
    return nlohmann::json::parse(AnswerOf(simulate + words + " --json 2>/dev/null").text)
        .at("episodes")
        .at(0)
        .at("state_sha256")
        .get<std::string>();
  };
  EXPECT_EQ(state_of("--opener expert --handler expert --grasper expert"), StateAfter({}));
  EXPECT_EQ(state_of("--grasper random"), StateAfter({.grasper = "random"}));
  const ProgramAnswer unknown = AnswerOf(simulate + "--grasper rondom 2>&1");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.text.find("did you mean \"random\""), std::string::npos) << unknown.text;
}

}  // namespace
}  // namespace doorforge
