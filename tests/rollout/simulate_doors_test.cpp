// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/simulate_doors.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/environment_preset.h"
#include "doorforge/core/error.h"

namespace doorforge {
namespace {

// Eight of ten doors of two categories open.
std::vector<SimulatedEpisode> EightOfTen() {
  std::vector<SimulatedEpisode> episodes(10);
  for (int i = 0; i < 10; ++i) {
    SimulatedEpisode& simulated = episodes[static_cast<std::size_t>(i)];
    simulated.door.id = "door";
    simulated.door.category = i < 4 ? Category::kCar : Category::kSafe;
    simulated.seed = 7;
    simulated.index = i;
    simulated.episode.outcome = i < 2 ? EpisodeOutcome::kNotReached : EpisodeOutcome::kOpened;
  }
  return episodes;
}

// The interval is that of 8 of 10 in tables: 49.02 % to 94.33 %.
TEST(SimulateDoors, TalliesAllEpisodesAndEachCategory) {
  const auto tallies = TallyOutcomes(EightOfTen());
  ASSERT_EQ(tallies.size(), 3U);
  EXPECT_EQ(tallies.at("overall").opened, 8);
  EXPECT_NEAR(tallies.at("overall").low, 0.4902, 5e-5);
  EXPECT_NEAR(tallies.at("overall").high, 0.9433, 5e-5);
  EXPECT_EQ(tallies.at("car").episodes, 4);
  EXPECT_EQ(tallies.at("car").outcomes.at("not_reached"), 2);
  EXPECT_EQ(tallies.at("safe").opened, 6);
  EXPECT_EQ(tallies.at("safe").high, 1);
}

TEST(SimulateDoors, TheDocumentHasTheTalliesAndEveryEpisode) {
  const nlohmann::ordered_json json = SimulatedToJson(EightOfTen());
  EXPECT_EQ(json["schema"], "doorforge.simulate");
  EXPECT_EQ(json["success"]["overall"]["rate"], 0.8);
  ASSERT_EQ(json["episodes"].size(), 10U);
  EXPECT_EQ(json["episodes"][9]["outcome"], "opened");
  EXPECT_EQ(NameOf(EightOfTen()[9]), "door_seed7_9");
}

TEST(SimulateDoors, NoEpisodesMakeNoTally) { EXPECT_TRUE(TallyOutcomes({}).empty()); }

TEST(EnvironmentPresets, EachIsReadAndTheUsersSettingsGoOverIt) {
  EXPECT_EQ(EnvironmentPresets().size(), 7U);
  for (const std::string& name : EnvironmentPresets()) {
    const auto config = LoadConfig<SimulateConfig>(ConfigSources{name, "", {}});
    EXPECT_EQ(config.scene.episode.grip_needed, 0) << name;
    EXPECT_LE(config.scene.episode.open_angle_rad, config.scene.physics.finish_hinge_rad + 0.01);
    const auto changed = LoadConfig<SimulateConfig>(
        ConfigSources{name, "", {"scene.physics.base=yaw", "scene.latch=door"}});
    EXPECT_EQ(changed.scene.physics.base, RobotBase::kYaw);
    EXPECT_EQ(changed.scene.latch, SceneLatch::kOfDoor);
    EXPECT_EQ(changed.cloud.whole, config.cloud.whole);
  }
  EXPECT_THROW(LoadConfig<SimulateConfig>(ConfigSources{"dorgym", "", {}}), Error);
}

// The option's word is a setting like others: over a file's, under those of --set, and recorded.
TEST(EnvironmentPresets, TheSimulatorIsASettingThatIsRecordedWhereItIsNotBullet) {
  const auto judge = LoadConfig<SimulateConfig>(ConfigSources{"", "", {}, "mujoco"});
  EXPECT_EQ(judge.scene.physics.simulator, Simulator::kMujoco);
  EXPECT_EQ(ToJson(judge)["scene"]["physics"]["simulator"], "mujoco");
  const auto again = LoadConfig<SimulateConfig>(
      ConfigSources{"", "", {"scene.physics.simulator=bullet"}, "mujoco"});
  EXPECT_EQ(again.scene.physics.simulator, Simulator::kBullet);
  EXPECT_FALSE(ToJson(again)["scene"]["physics"].contains("simulator"));
  EXPECT_THROW(LoadConfig<SimulateConfig>(ConfigSources{"", "", {}, "bulet"}), Error);
}

}  // namespace
}  // namespace doorforge
