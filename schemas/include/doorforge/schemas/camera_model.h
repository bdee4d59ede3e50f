// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "doorforge/core/rigid_transform.h"

namespace doorforge {

/// Pinhole camera with square pixels. The default is UniDoorManip's (reference code).
struct CameraModel {
  Eigen::Vector3d position_m{1.8, 0, 1.8};  ///< In the world.
  Eigen::Vector3d target_m{0.01, 0, 1.5};   ///< Point in the middle of the image.
  Eigen::Vector3d up{0, 0, 1};
  int width = 256;
  int height = 256;
  double horizontal_fov_rad = 1.5707963267948966;
};

/// OpenCV convention: camera x to the right, y down, z forward.
RigidTransform WorldFromCamera(const CameraModel& camera);

/// Pinhole matrix [[f, 0, cx], [0, f, cy], [0, 0, 1]] in pixels; pixel (0, 0) has its centre at
/// (0.5, 0.5).
Eigen::Matrix3d IntrinsicMatrix(const CameraModel& camera);

nlohmann::ordered_json CameraToJson(const CameraModel& camera);
/// Throws Error(kFormat).
CameraModel CameraFromJson(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace doorforge
