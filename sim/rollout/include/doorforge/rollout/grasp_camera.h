// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/scene.h"

namespace doorforge {

/// How the camera shows the handle that a grasp is chosen on. The policies' camera shows a handle
/// with a few pixels, and farthest point sampling over the whole door leaves a handful of points on
/// it: enough to follow it, too little to say how fingers fit around it.
struct GraspCameraConfig {
  int resolution_scale =
      2;  ///< It multiplies the pixels along each side of the scene's camera, 1 to 8.
  double crop_radius_m =
      0.4;  ///< It is the CloudExtent::crop_radius_m of the cloud about the contact.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("finer", self.resolution_scale);
    visit("within_m", self.crop_radius_m);
  }
};

/// Throws Error(kInvalidConfig) on a number out of range.
void CheckGraspCamera(const GraspCameraConfig& config);

/// Returns the scene with that camera.
Scene SceneOf(const GraspCameraConfig& config, Scene scene);

}  // namespace doorforge
