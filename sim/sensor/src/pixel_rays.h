// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "doorforge/schemas/camera_model.h"

namespace doorforge {

/// Rays through an image, in the world. Directions have unit length along the optical axis, so a
/// ray's parameter is the depth of the point it reaches.
class PixelRays {
 public:
  explicit PixelRays(const CameraModel& camera)
      : world_from_camera_(WorldFromCamera(camera)), intrinsics_(IntrinsicMatrix(camera)) {}

  Eigen::Vector3d origin() const { return world_from_camera_.translation(); }
  Eigen::Vector3d forward() const { return world_from_camera_.linear().col(2); }

  /// Direction through (u, v) [pixels]; (0.5, 0.5) is the centre of the first pixel. Rounded to
  /// float, which is what the ray caster is given.
  Eigen::Vector3f Direction(double u, double v) const {
    const Eigen::Vector3d in_camera((u - intrinsics_(0, 2)) / intrinsics_(0, 0),
                                    (v - intrinsics_(1, 2)) / intrinsics_(1, 1), 1);
    return (world_from_camera_.linear() * in_camera).cast<float>();
  }

 private:
  RigidTransform world_from_camera_;
  Eigen::Matrix3d intrinsics_;
};

}  // namespace doorforge
