// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "doorforge/datagen/collect.h"
#include "doorforge/datagen/collection_plan.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// Settings of `datagen open`, all of which change its bytes.
struct OpenStageConfig {
  std::uint64_t episodes = 200;
  std::uint64_t seed = 1;
  CollectionConfig collection;
  /// Noisy actions and a door opened further than asked for: a policy trained on flawless episodes
  /// that end at 45 degrees has not seen what its own small errors lead to.
  SceneConfig scene = {.physics = {.max_opening_actions = 30,
                                   .finish_hinge_rad = 1.05,
                                   .action_noise_m = 0.01,
                                   .action_noise_rad = 0.05}};
  OpeningExpertConfig expert;
  CloudConfig cloud;
  /// Adds preview.png to each episode: depth at the first and at the last decision.
  bool preview = true;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("episodes", self.episodes);
    visit("seed", self.seed);
    visit("collection", self.collection);
    visit("scene", self.scene);
    visit("expert", self.expert);
    visit("cloud", self.cloud);
    visit("preview", self.preview);
  }
};

/// Samples the scene of a planned episode, lets the expert open the door before the camera, and
/// describes what happened. Thread-safe; a pure function of its arguments.
CollectedEpisode RunOpenEpisode(const PlannedEpisode& planned, const DoorAsset& door,
                                const RobotModel& robot, const OpenStageConfig& config);

}  // namespace doorforge
