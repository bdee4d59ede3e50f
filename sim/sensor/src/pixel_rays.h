// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "doorforge/sensor/pinhole_view.h"

namespace doorforge {

/// Rays through an image, in the world. Directions have unit length along the optical axis, so a
/// ray's parameter is the depth of the point it reaches.
class PixelRays {
 public:
  explicit PixelRays(const PinholeView& view) : view_(view) {}
  explicit PixelRays(const CameraModel& camera) : PixelRays(ViewOf(camera)) {}

  Eigen::Vector3d origin() const { return view_.world_from_camera.translation(); }
  Eigen::Vector3d forward() const { return view_.world_from_camera.linear().col(2); }

  /// Direction through (u, v) [pixels]; (0.5, 0.5) is the centre of the first pixel. Rounded to
  /// float, which is what the ray caster is given.
  Eigen::Vector3f Direction(double u, double v) const {
    const Eigen::Vector3d in_camera((u - view_.cx) / view_.fx, (v - view_.cy) / view_.fy, 1);
    return (view_.world_from_camera.linear() * in_camera).cast<float>();
  }

 private:
  PinholeView view_;
};

}  // namespace doorforge
