// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/sensor/picture.h"

namespace doorforge {

struct EpisodeStripConfig {
  int frames = 7;     ///< At most, 2 or more; a short episode may have fewer.
  int tile_px = 320;  ///< Width of a picture; height is 5/6 of it.
  std::uint64_t seed = 1;
  std::uint64_t episode = 0;
  SceneConfig scene;
};

/// What a frame shows.
struct StripFrame {
  std::string stage;  ///< It is the word for SceneSnapshot::phase.
  double time_s = 0;
  double hinge_rad = 0;
  double handle_rad = 0;
};

/// Pictures of an episode of the rule-based expert, in the order of time: how it reaches, grasps
/// and unlocks, then the opening at about equal angles of the hinge.
struct EpisodeStrip {
  Episode episode;
  std::vector<StripFrame> frames;
  std::vector<Picture> camera;  ///< One a frame, from the scene's camera.
  std::vector<Picture> side;    ///< From beside the robot, where the hinge is.
  std::vector<Picture> handle;  ///< Close to the handle, moving along with the leaf.
};

/// Runs the episode and draws it. Any outcome is drawn.
///
/// @throws Error as SampleScene() and RunEpisode() do; Error(kInvalidArgument) if the config is out
///     of range.
EpisodeStrip DrawEpisode(const DoorAsset& door, const RobotModel& robot,
                         const EpisodeStripConfig& config = {});

/// One episode: a row for each of the three views, with stage, time and angles below.
Picture StripPicture(const EpisodeStrip& strip);

/// Several episodes: for each the handle when it is held and turned, then the side views; rows are
/// filled up with white. Below stand the stage and the angles of hinge and handle; `titles` has one
/// name a strip.
Picture StripSheet(std::span<const EpisodeStrip> strips, std::span<const std::string> titles);

}  // namespace doorforge
