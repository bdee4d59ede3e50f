// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "doorforge/schemas/camera_model.h"
#include "doorforge/sensor/pinhole_view.h"

namespace doorforge {

/// Directions in the world through pixels, whose length along the optical axis is 1.
class PinholeDirections {
 public:
  explicit PinholeDirections(const CameraModel& camera) {
    const PinholeView view = ViewOf(camera);
    const Eigen::Matrix3d& axes = view.world_from_camera.linear();
    origin_ = view.world_from_camera.translation().cast<float>();
    corner_ = (axes * Eigen::Vector3d(-view.cx / view.fx, -view.cy / view.fy, 1)).cast<float>();
    across_ = (axes.col(0) / view.fx).cast<float>();
    down_ = (axes.col(1) / view.fy).cast<float>();
  }

  const Eigen::Vector3f& origin() const { return origin_; }
  Eigen::Vector3f Through(float u, float v) const { return corner_ + u * across_ + v * down_; }

 private:
  Eigen::Vector3f origin_;
  Eigen::Vector3f corner_;
  Eigen::Vector3f across_;
  Eigen::Vector3f down_;
};

}  // namespace doorforge
