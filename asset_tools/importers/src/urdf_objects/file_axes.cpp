// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "urdf_objects/file_axes.h"

#include <cmath>

#include <Eigen/Geometry>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

Eigen::Matrix3d TurnTo(const Eigen::Vector3d& front, const Eigen::Vector3d& up) {
  Eigen::Matrix3d turn;
  turn.row(0) = front;
  turn.row(1) = up.cross(front);
  turn.row(2) = up;
  return turn;
}

}  // namespace

Eigen::Vector3d AxisNamed(const std::string& name, const std::string& flag) {
  const bool negative = name.starts_with("-");
  const std::string axis = negative ? name.substr(1) : name;
  if (axis != "x" && axis != "y" && axis != "z")
    throw Error(ErrorCode::kInvalidArgument,
                flag + ": \"" + name + "\" is no axis; allowed are x, y, z, -x, -y and -z");
  return (negative ? -1.0 : 1.0) * Eigen::Vector3d::Unit(axis[0] - 'x');
}

Eigen::Matrix3d UprightFrom(const std::string& up) {
  const Eigen::Vector3d axis = AxisNamed(up, "--up");
  return TurnTo({std::abs(axis.z()), std::abs(axis.x()), std::abs(axis.y())}, axis);
}

Eigen::Matrix3d PartAxesFrom(const std::string& up, const std::string& front) {
  const Eigen::Vector3d up_axis = AxisNamed(up, "--up");
  const Eigen::Vector3d front_axis = AxisNamed(front, "--front");
  if (std::abs(up_axis.dot(front_axis)) > 0.5)
    throw Error(ErrorCode::kInvalidArgument,
                "--front: \"" + front + "\" lies along --up \"" + up + "\"; give another axis");
  return TurnTo(front_axis, up_axis);
}

}  // namespace doorforge::internal
