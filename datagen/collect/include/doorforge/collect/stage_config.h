// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

#include "doorforge/dataset/collection_plan.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/pictures/pictures_config.h"
#include "doorforge/rollout/grasp_camera.h"
#include "doorforge/rollout/handle_expert.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/random_grasp.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// Settings of `datagen STAGE`, all of which change its bytes.
struct StageConfig {
  Stage stage = Stage::kOpen;  ///< Not a setting: decides which ones there are.
  std::uint64_t episodes = 200;
  std::uint64_t seed = 1;
  CollectionConfig collection;
  SceneConfig scene;
  OpeningExpertConfig expert;  ///< Opens, where no trained policy does.
  HandleExpertConfig handle;   ///< Turns the handle, where no trained policy does. Not of "open".
  /// Share of the episodes of "open" and "handle" in which the hand takes hold at a sampled grasp
  /// instead of the expert's: only a policy that has seen them can go on from a learned grasp.
  double sampled_grasps = 0;
  RandomGraspConfig grasp;  ///< How grasps are sampled.
  /// With a learner: it drives 1 to this many decisions, drawn for each episode, then the expert.
  int learner_decisions = 16;
  GraspCameraConfig grasp_camera;  ///< At "grasp": what the recorded cloud is seen with.
  /// At "grasp". False: what would be taken hold of is recorded and not tried, and rated 0: looks
  /// at closed doors, which a finder of handles learns from. Written into files only then.
  bool tries = true;
  RememberedViewConfig remembered;  ///< At "handle": what the recorded clouds are joined with.
  CloudConfig cloud;
  /// Adds preview.png to each episode: depth at the first and at the last look.
  bool preview = true;
  PicturesConfig pictures;  ///< Written into files only where there are any.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("episodes", self.episodes);
    visit("seed", self.seed);
    visit("collection", self.collection);
    visit("scene", self.scene);
    visit("expert", self.expert);
    if (self.stage != Stage::kOpen) visit("handle", self.handle);
    if (self.stage != Stage::kGrasp) {
      visit("sampled_grasps", self.sampled_grasps);
      visit("learner_decisions", self.learner_decisions);
    }
    visit("grasp", self.grasp);
    if (self.stage == Stage::kGrasp) visit("grasp_look", self.grasp_camera);
    if (self.stage == Stage::kGrasp && (!std::is_const_v<Self> || !self.tries))
      visit("tries", self.tries);
    if (self.stage == Stage::kHandle) visit("remembered", self.remembered);
    visit("cloud", self.cloud);
    visit("preview", self.preview);
    if (!std::is_const_v<Self> || self.pictures.IsOn()) visit("pictures", self.pictures);
  }
};

/// The settings with which a stage begins. Recorded actions are executed with noise, and the door
/// is opened further than asked for: a policy trained on flawless episodes that end at 45 degrees
/// has not seen what its own small errors lead to.
StageConfig DefaultsOf(Stage stage);

/// Throws Error(kInvalidConfig) on a setting that no episode can run with.
void CheckStageConfig(const StageConfig& config);

}  // namespace doorforge
