// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/rigid_transform.h"

#include <cmath>
#include <string>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

[[noreturn]] void ThrowFormat(const std::string& path, const std::string& problem) {
  throw Error(ErrorCode::kFormat, path + ": " + problem);
}

std::vector<double> Numbers(const nlohmann::ordered_json& json, std::size_t count,
                            const std::string& path) {
  if (!json.is_array() || json.size() != count)
    ThrowFormat(path, "expected an array of " + std::to_string(count) + " numbers");
  std::vector<double> numbers;
  for (const auto& element : json) {
    if (!element.is_number() || !std::isfinite(element.get<double>()))
      ThrowFormat(path, "expected finite numbers");
    numbers.push_back(element.get<double>());
  }
  return numbers;
}

const nlohmann::ordered_json& Member(const nlohmann::ordered_json& json, const char* key,
                                     const std::string& path) {
  if (!json.is_object() || !json.contains(key))
    ThrowFormat(path, std::string("missing key \"") + key + '"');
  return json.at(key);
}

}  // namespace

RigidTransform RotationAbout(const Eigen::Vector3d& axis, double angle_rad) {
  return RigidTransform(Eigen::AngleAxisd(angle_rad, axis));
}

RigidTransform Translation(const Eigen::Vector3d& offset_m) {
  RigidTransform transform = RigidTransform::Identity();
  transform.translation() = offset_m;
  return transform;
}

RigidTransform FromXyzRpy(const Eigen::Vector3d& xyz_m, const Eigen::Vector3d& rpy_rad) {
  return Translation(xyz_m) * RotationAbout(Eigen::Vector3d::UnitZ(), rpy_rad.z()) *
         RotationAbout(Eigen::Vector3d::UnitY(), rpy_rad.y()) *
         RotationAbout(Eigen::Vector3d::UnitX(), rpy_rad.x());
}

Eigen::Vector3d RpyOf(const Eigen::Matrix3d& rotation) {
  const double cos_pitch = std::hypot(rotation(0, 0), rotation(1, 0));
  const double pitch = std::atan2(-rotation(2, 0), cos_pitch);
  if (cos_pitch < 1e-9) return {0.0, pitch, std::atan2(-rotation(0, 1), rotation(1, 1))};
  return {std::atan2(rotation(2, 1), rotation(2, 2)), pitch,
          std::atan2(rotation(1, 0), rotation(0, 0))};
}

Eigen::Vector3d RotationVector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.axis() * turn.angle();
}

Eigen::Vector3d Vector3FromJson(const nlohmann::ordered_json& json, const std::string& path) {
  const std::vector<double> numbers = Numbers(json, 3, path);
  return {numbers[0], numbers[1], numbers[2]};
}

nlohmann::ordered_json Vector3ToJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

nlohmann::ordered_json TransformToJson(const RigidTransform& transform) {
  Eigen::Quaterniond q(transform.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return {{"position_m", Vector3ToJson(transform.translation())},
          {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

RigidTransform TransformFromJson(const nlohmann::ordered_json& json, const std::string& path) {
  const std::vector<double> q =
      Numbers(Member(json, "quaternion_xyzw", path), 4, path + ".quaternion_xyzw");
  Eigen::Quaterniond quaternion(q[3], q[0], q[1], q[2]);
  if (std::abs(quaternion.norm() - 1.0) > 1e-6)
    ThrowFormat(path + ".quaternion_xyzw", "expected unit norm");
  RigidTransform transform(quaternion.normalized());
  transform.translation() = Vector3FromJson(Member(json, "position_m", path), path + ".position_m");
  return transform;
}

}  // namespace doorforge
