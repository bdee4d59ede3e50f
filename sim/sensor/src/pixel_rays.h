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
    return UnroundedDirection(u, v).cast<float>();
  }

  /// The point at a depth on the ray through (u, v): where every cloud, and every picture that is
  /// back-projected, puts it. All data sets have been written by this very arithmetic, of whose
  /// directions z alone is rounded, so it stays: docs/design/sensor.md, and Python's
  /// back_project(), which repeats it operation by operation.
  Eigen::Vector3d PointAt(double u, double v, double depth_m) const {
    const Eigen::Vector3d direction = UnroundedDirection(u, v);
    const auto z = static_cast<double>(static_cast<float>(direction.z()));
    return origin() + depth_m * Eigen::Vector3d(direction.x(), direction.y(), z);
  }

 private:
  // The order of the sums is part of the bytes of clouds.
  Eigen::Vector3d UnroundedDirection(double u, double v) const {
    const double x = (u - view_.cx) / view_.fx;
    const double y = (v - view_.cy) / view_.fy;
    const Eigen::Matrix4d& pose = view_.world_from_camera.matrix();
    return {(pose(0, 0) * x + pose(0, 1) * y) + pose(0, 2),
            (pose(1, 0) * x + pose(1, 1) * y) + pose(1, 2),
            pose(2, 0) * x + (pose(2, 1) * y + pose(2, 2))};
  }

  PinholeView view_;
};

}  // namespace doorforge
