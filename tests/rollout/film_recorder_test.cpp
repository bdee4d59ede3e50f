// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/film_recorder.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/run_episode.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

struct Filmed {
  Episode episode;
  EpisodeFilm film;
};

Filmed FilmOf(const DoorAsset& door, const Scene& scene) {
  FilmRecorder recorder;
  OpeningExpert expert;
  Episode episode = RunEpisode(scene, door, LoadMobileFranka(), expert, &recorder);
  EpisodeFilm film = recorder.Film(episode);
  return {std::move(episode), std::move(film)};
}

TEST(FilmRecorder, AnEpisodeGoesAsItDoesUnseen) {
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 3, 0);
  OpeningExpert expert;
  const Episode unseen = RunEpisode(scene, door, LoadMobileFranka(), expert, nullptr);
  const auto [episode, film] = FilmOf(door, scene);
  EXPECT_EQ(episode.state_sha256, unseen.state_sha256);
  EXPECT_EQ(film.state_sha256, unseen.state_sha256);
  EXPECT_EQ(film.outcome, EpisodeOutcome::kOpened);
}

TEST(FilmRecorder, InstantsAreThoseOfTheEpisode) {
  const DoorAsset door = MakePrimitiveDoor({});
  const auto [episode, film] = FilmOf(door, SampleScene(door, 3, 0));
  ASSERT_GT(film.instants.size(), episode.decisions.size());
  EXPECT_EQ(film.instants.front().phase, "start");
  EXPECT_EQ(film.instants.back().phase, "end");
  double before = -1;
  for (const FilmInstant& instant : film.instants) {
    EXPECT_GT(instant.time_s, before);
    if (before >= 0) {
      EXPECT_LT(instant.time_s - before, 0.35);
    }
    before = instant.time_s;
    EXPECT_LE(instant.force_n, episode.peak_force_n + 1e-9);
  }
  EXPECT_EQ(film.instants.front().force_n, 0);
  // what the record of the decisions says, which another part of the room writes
  for (const Decision& decision : episode.decisions) {
    const auto found = std::ranges::find_if(film.instants, [&](const FilmInstant& instant) {
      return std::abs(instant.time_s - decision.time_s) < 1e-9;
    });
    ASSERT_NE(found, film.instants.end());
    EXPECT_EQ(found->hinge_rad, decision.hinge_rad);
    EXPECT_EQ(found->handle_rad, decision.handle_rad);
    EXPECT_TRUE(found->asked_m.has_value());
    for (std::size_t joint = 0; joint < found->robot.size(); ++joint)
      EXPECT_EQ(found->robot[joint], decision.state[joint]);
  }
}

// The robot stands too far away: nobody watches the end of an attempt that does not arrive.
TEST(FilmRecorder, AFailureWhileReachingIsNamedSo) {
  const DoorAsset door = MakePrimitiveDoor({});
  Scene scene = SampleScene(door, 3, 0);
  scene.world_from_robot_base.translation().x() += 2;
  const auto [episode, film] = FilmOf(door, scene);
  ASSERT_EQ(episode.outcome, EpisodeOutcome::kJointLimit) << episode.detail;
  ASSERT_GT(film.instants.size(), 2U);
  EXPECT_EQ(film.instants.front().phase, "start");
  EXPECT_EQ(film.instants.back().phase, "grasp");
}

}  // namespace
}  // namespace doorforge
