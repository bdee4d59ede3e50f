// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/episode_strip.h"

#include <array>
#include <string>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/rollout/episode_sheet.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

TEST(EpisodeStrip, ShowsTheStagesInOrderAndEndsWithTheDoorOpen) {
  const DoorAsset door = MakePrimitiveDoor({});
  const RobotModel robot = LoadMobileFranka();
  EpisodeStripConfig config;
  config.frames = 6;
  config.tile_px = 72;
  const EpisodeStrip strip = DrawEpisode(door, robot, config);
  ASSERT_EQ(strip.episode.outcome, EpisodeOutcome::kOpened) << strip.episode.detail;
  const std::array<std::string, 6> stages = {"reach", "grasp", "unlock", "open", "open", "end"};
  ASSERT_EQ(strip.frames.size(), stages.size());
  for (std::size_t i = 0; i < stages.size(); ++i) {
    EXPECT_EQ(strip.frames[i].stage, stages.at(i));
    if (i > 0) {
      EXPECT_GT(strip.frames[i].time_s, strip.frames[i - 1].time_s);
    }
  }
  EXPECT_NEAR(strip.frames[0].hinge_rad, 0, 0.01);
  EXPECT_GE(strip.frames[2].handle_rad, door.latch.unlock_angle_rad);
  EXPECT_NEAR(strip.frames[5].hinge_rad, strip.episode.peak_hinge_rad, 0.05);
  const Picture picture = StripPicture(strip);
  EXPECT_GE(picture.width, 6 * 72);
  EXPECT_NE(strip.handle[0].rgb, strip.handle[2].rgb);
}

TEST(EpisodeStrip, RefusesASingleFrame) {
  EpisodeStripConfig config;
  config.frames = 1;
  EXPECT_THROW(DrawEpisode(MakePrimitiveDoor({}), LoadMobileFranka(), config), Error);
}

TEST(EpisodeSheet, SaysHowEachDoorEnded) {
  const std::filesystem::path doors[] = {"doors/a", "b"};
  const EpisodeSheet sheet{{}, {EpisodeOutcome::kOpened, EpisodeOutcome::kDoorStuck}};
  EXPECT_EQ(OutcomesText(doors, sheet), "a: opened\nb: door_stuck\n");
}

}  // namespace
}  // namespace doorforge
