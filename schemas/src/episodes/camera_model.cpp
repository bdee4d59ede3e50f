// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/camera_model.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

namespace doorforge {

RigidTransform WorldFromCamera(const CameraModel& camera) {
  const Eigen::Vector3d forward = (camera.target_m - camera.position_m).normalized();
  const Eigen::Vector3d right = forward.cross(camera.up).normalized();
  RigidTransform world_from_camera = Translation(camera.position_m);
  world_from_camera.linear().col(0) = right;
  world_from_camera.linear().col(1) = forward.cross(right);
  world_from_camera.linear().col(2) = forward;
  return world_from_camera;
}

Eigen::Matrix3d IntrinsicMatrix(const CameraModel& camera) {
  const double focal = camera.width / (2.0 * std::tan(camera.horizontal_fov_rad / 2));
  Eigen::Matrix3d intrinsics = Eigen::Matrix3d::Identity();
  intrinsics(0, 0) = intrinsics(1, 1) = focal;
  intrinsics(0, 2) = camera.width / 2.0;
  intrinsics(1, 2) = camera.height / 2.0;
  return intrinsics;
}

nlohmann::ordered_json CameraToJson(const CameraModel& camera) {
  return {{"position_m", Vector3ToJson(camera.position_m)},
          {"target_m", Vector3ToJson(camera.target_m)},
          {"up", Vector3ToJson(camera.up)},
          {"width", camera.width},
          {"height", camera.height},
          {"horizontal_fov_rad", camera.horizontal_fov_rad}};
}

CameraModel CameraFromJson(const nlohmann::ordered_json& json, const std::string& path) {
  CameraModel camera;
  camera.position_m = Vector3FromJson(MemberOf(json, "position_m", path), path + ".position_m");
  camera.target_m = Vector3FromJson(MemberOf(json, "target_m", path), path + ".target_m");
  camera.up = Vector3FromJson(MemberOf(json, "up", path), path + ".up");
  camera.width = ValueOf<int>(json, "width", path);
  camera.height = ValueOf<int>(json, "height", path);
  camera.horizontal_fov_rad = ValueOf<double>(json, "horizontal_fov_rad", path);
  const bool valid = camera.width > 0 && camera.height > 0 && camera.width <= 8192 &&
                     camera.height <= 8192 && camera.horizontal_fov_rad > 0 &&
                     camera.horizontal_fov_rad < 3.1;
  if (!valid) throw Error(ErrorCode::kFormat, path + ": image size or field of view out of range");
  return camera;
}

}  // namespace doorforge
