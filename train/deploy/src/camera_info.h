// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "doorforge/sensor/lens.h"
#include "doorforge/sensor/pinhole_view.h"

#include "named_numbers.h"

namespace doorforge::internal {

/// What a calibration says of a camera, without its pose.
struct CameraInfo {
  PinholeView raw;  ///< Of the picture as the sensor took it, seen through `lens`.
  LensDistortion lens;
  PinholeView rectified;  ///< Of the picture that rectification made of it.
  Eigen::Matrix3d rectification = Eigen::Matrix3d::Identity();  ///< Rectified from raw frame.
  bool alike = false;                                           ///< Both are the same picture.
};

/// Whether a file's keys are those of ROS's sensor_msgs/CameraInfo, as `ros2 topic echo` prints it
/// or camera_calibration stores it, or of OpenCV's calibration.
bool IsCameraInfo(const nlohmann::ordered_json& json);

/// Reads such a file's values. Throws Error(kInvalidConfig) naming `file` and the key.
CameraInfo CameraInfoOf(const NamedNumbers& file);

/// A lens by its model's name, as ROS or librealsense calls it. Throws Error(kInvalidConfig).
LensDistortion LensNamed(const NamedNumbers& file, const std::string& model,
                         const std::vector<double>& coefficients);

}  // namespace doorforge::internal
