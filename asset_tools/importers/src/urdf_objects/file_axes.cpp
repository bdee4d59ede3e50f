// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "urdf_objects/file_axes.h"

#include <charconv>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

// Sine of five degrees: less of an axis that is square to another says nothing.
constexpr double kLeastApart = 0.0872;

// Three finite numbers between commas.
std::optional<Eigen::Vector3d> NumbersIn(const std::string& text) {
  Eigen::Vector3d numbers;
  const char* at = text.data();
  const char* end = at + text.size();
  for (int i = 0; i < 3; ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return std::nullopt;
    const auto [next, error] = std::from_chars(at, end, numbers[i]);
    if (error != std::errc{}) return std::nullopt;
    at = next;
  }
  if (at != end || !numbers.allFinite()) return std::nullopt;
  return numbers;
}

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

Eigen::Vector3d DirectionNamed(const std::string& name, const std::string& flag) {
  if (name.find(',') == std::string::npos) return AxisNamed(name, flag);
  const std::optional<Eigen::Vector3d> numbers = NumbersIn(name);
  const double length = numbers ? numbers->stableNorm() : 0;
  if (!(length > 0) || !std::isfinite(length))
    throw Error(ErrorCode::kInvalidArgument,
                flag + ": \"" + name +
                    "\" is no direction; expected three numbers that are not "
                    "all 0, such as 0.6,0.8,0");
  return *numbers / length;
}

Eigen::Matrix3d PartAxesFrom(const std::string& up, const std::string& front) {
  const Eigen::Vector3d front_axis = DirectionNamed(front, "--front");
  Eigen::Vector3d up_axis = DirectionNamed(up, "--up");
  const double along = up_axis.dot(front_axis);
  // axes of the file are square, and stay the numbers that they are
  if (along != 0) up_axis -= along * front_axis;
  const double left = up_axis.norm();
  if (left < kLeastApart)
    throw Error(ErrorCode::kInvalidArgument,
                "--front: \"" + front + "\" lies along --up \"" + up + "\"; give another axis");
  return TurnTo(front_axis, up_axis / left);
}

}  // namespace doorforge::internal
