// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/grasp_look.h"

#include "doorforge/core/error.h"

namespace doorforge {

void CheckGraspLook(const GraspLook& look) {
  Require(look.finer >= 1 && look.finer <= 8, ErrorCode::kInvalidConfig,
          "config.grasp_look.finer: out of 1..8");
  Require(look.within_m >= 0 && look.within_m < 100, ErrorCode::kInvalidConfig,
          "config.grasp_look.within_m: out of 0..100");
}

Scene SceneOf(const GraspLook& look, Scene scene) {
  scene.camera.width *= look.finer;
  scene.camera.height *= look.finer;
  return scene;
}

}  // namespace doorforge
