// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/motion_way.h"

#include <cmath>

namespace doorforge {
namespace {

// The axis of a lever or knob points out of the leaf; that of a flap lies in it.
constexpr double kPointsOut = 0.5;

MotionWay SenseOfTurning(const DoorAsset& door) {
  const Eigen::Matrix3d leaf_from_handle = door.handle_joint.parent_from_child_at_zero.linear();
  const Eigen::Vector3d axis = leaf_from_handle * door.handle_joint.axis;
  if (std::abs(axis.x()) < kPointsOut) return MotionWay::kUsual;
  const Eigen::Vector3d grip = leaf_from_handle * door.handle_from_grasp.translation();
  const bool points_right =
      door.mechanism == Mechanism::kLever ? grip.y() > 0 : door.hinge_side == HingeSide::kRight;
  return (axis.x() > 0) == points_right ? MotionWay::kOther : MotionWay::kUsual;
}

}  // namespace

MotionWay WayOf(const DoorAsset& door, Stage stage) {
  if (stage == Stage::kOpen && door.opening == Opening::kPush) return MotionWay::kOther;
  if (stage == Stage::kHandle) return SenseOfTurning(door);
  return MotionWay::kUsual;
}

}  // namespace doorforge
