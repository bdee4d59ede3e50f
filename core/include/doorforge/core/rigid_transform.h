// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <nlohmann/json_fwd.hpp>

namespace doorforge {

/// A rigid transform named `a_from_b` maps coordinates in frame b to coordinates in frame a.
using RigidTransform = Eigen::Isometry3d;

/// Turn about the origin by `angle_rad` (right-hand rule) around the unit vector `axis`.
RigidTransform RotationAbout(const Eigen::Vector3d& axis, double angle_rad);

RigidTransform Translation(const Eigen::Vector3d& offset_m);

/// URDF convention: rotation Rz(yaw) * Ry(pitch) * Rx(roll), then the offset.
RigidTransform FromXyzRpy(const Eigen::Vector3d& xyz_m, const Eigen::Vector3d& rpy_rad);

/// Inverse of FromXyzRpy; pitch in [-pi/2, pi/2]. At the poles yaw takes the whole turn (roll = 0).
Eigen::Vector3d RpyOf(const Eigen::Matrix3d& rotation);

/// Rotation vector (axis times angle in [0, pi]) of a rotation matrix.
Eigen::Vector3d RotationVector(const Eigen::Matrix3d& rotation);

/// Throws Error(kFormat) unless `json` is an array of three finite numbers; `path` names it.
Eigen::Vector3d Vector3FromJson(const nlohmann::ordered_json& json, const std::string& path);
nlohmann::ordered_json Vector3ToJson(const Eigen::Vector3d& v);

/// {"position_m": [x, y, z], "quaternion_xyzw": [x, y, z, w]}; w >= 0, unit norm.
nlohmann::ordered_json TransformToJson(const RigidTransform& transform);
/// Throws Error(kFormat) on missing keys, non-finite numbers, or a quaternion off unit norm by
/// 1e-6.
RigidTransform TransformFromJson(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace doorforge
