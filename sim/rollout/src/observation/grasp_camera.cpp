// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/grasp_camera.h"

#include "doorforge/core/error.h"

namespace doorforge {

void CheckGraspCamera(const GraspCameraConfig& config) {
  Require(config.resolution_scale >= 1 && config.resolution_scale <= 8, ErrorCode::kInvalidConfig,
          "config.grasp_look.finer: out of 1..8");
  Require(config.crop_radius_m >= 0 && config.crop_radius_m < 100, ErrorCode::kInvalidConfig,
          "config.grasp_look.within_m: out of 0..100");
}

Scene SceneOf(const GraspCameraConfig& config, Scene scene) {
  scene.camera.width *= config.resolution_scale;
  scene.camera.height *= config.resolution_scale;
  return scene;
}

}  // namespace doorforge
