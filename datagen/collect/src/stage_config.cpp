// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/stage_config.h"

#include <string>

#include "doorforge/core/error.h"
#include "doorforge/physics/door_world.h"

namespace doorforge {
namespace {

// The plan of so many episodes takes half a gigabyte.
constexpr std::uint64_t kMostEpisodes = 10'000'000;

}  // namespace

StageConfig DefaultsOf(Stage stage) {
  StageConfig config;
  config.stage = stage;
  PhysicsConfig& physics = config.scene.physics;
  switch (stage) {
    case Stage::kOpen:
      physics.max_opening_actions = 30;
      physics.finish_hinge_rad = 1.05;
      physics.action_noise_m = 0.01;
      physics.action_noise_rad = 0.05;
      break;
    case Stage::kHandle:
      // a hand on a locked door cannot give way: more noise would tear it off the handle
      physics.action_noise_m = 0.004;
      physics.action_noise_rad = 0.03;
      config.collection.episodes_per_shard = 512;
      config.learner_decisions = 6;
      break;
    case Stage::kGrasp:
      config.collection.episodes_per_shard = 1024;
      break;
  }
  return config;
}

void CheckStageConfig(const StageConfig& config) {
  Require(config.episodes >= 1 && config.episodes <= kMostEpisodes, ErrorCode::kInvalidConfig,
          "config.episodes: " + std::to_string(config.episodes) + ", expected 1 to " +
              std::to_string(kMostEpisodes) + "; more than that, collect with several seeds");
  Require(config.cloud.point_count >= 1 && config.cloud.point_count <= 1000000,
          ErrorCode::kInvalidConfig, "config.cloud.point_count: out of 1..1000000");
  CheckDepthNoise(config.cloud.noise);
  CheckRandomGrasp(config.grasp);
  CheckGraspCamera(config.grasp_camera);
  CheckRememberedView(config.remembered);
  CheckPictures(config.pictures);
  CheckPictures(config.pictures, config.cloud);
  Require(config.sampled_grasps >= 0 && config.sampled_grasps <= 1, ErrorCode::kInvalidConfig,
          "config.sampled_grasps: out of 0..1");
  Require(config.learner_decisions >= 1 && config.learner_decisions <= 1000,
          ErrorCode::kInvalidConfig, "config.learner_decisions: out of 1..1000");
  RequireSimulator(config.scene.physics.simulator);
  Require(config.scene.physics.max_handle_actions >= 1 &&
              config.scene.physics.max_handle_actions <= 1000,
          ErrorCode::kInvalidConfig, "config.scene.physics.max_handle_actions: out of 1..1000");
}

}  // namespace doorforge
