// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/scene.h"

namespace doorforge {

/// The look that a grasp is chosen from. The policies' camera shows a handle with a few pixels, and
/// farthest point sampling over the whole door leaves a handful of points on it: enough to follow
/// it, too little to say how fingers fit around it.
struct GraspLook {
  int finer = 2;          ///< Times as many pixels along each side of the scene's camera, 1 to 8.
  double within_m = 0.4;  ///< CloudExtent::within_m of the cloud about the contact.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("finer", self.finer);
    visit("within_m", self.within_m);
  }
};

/// Throws Error(kInvalidConfig) on a number out of range.
void CheckGraspLook(const GraspLook& look);

/// The scene with the camera of the look.
Scene SceneOf(const GraspLook& look, Scene scene);

}  // namespace doorforge
