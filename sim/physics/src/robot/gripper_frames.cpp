// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/gripper_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doorforge::internal {
namespace {

constexpr double kTipBeyondTcp = 0.0085;
constexpr double kTipLength = 0.02;  // of a finger, that shows where its pad is

std::size_t LeftOf(const RobotDescription& robot) { return robot.joints.size() - 2; }

// Vertices of a finger at a position, or of the hand, in the hand's body.
std::vector<Eigen::Vector3d> PointsOf(const RobotDescription& robot, std::size_t joint,
                                      double position) {
  RigidTransform hand_from_body = RigidTransform::Identity();
  if (joint >= LeftOf(robot)) {
    const RobotJoint& finger = robot.joints[joint];
    hand_from_body = finger.parent_from_joint * Translation(position * finger.axis);
  }
  std::vector<Eigen::Vector3d> points;
  for (const RobotPiece& piece : robot.hulls) {
    if (piece.joint != static_cast<int>(joint)) continue;
    for (const Eigen::Vector3d& vertex : piece.mesh.vertices)
      points.emplace_back(hand_from_body * vertex);
  }
  return points;
}

Eigen::Vector3d OpeningOf(const RobotJoint& finger) {
  return finger.parent_from_joint.linear() * finger.axis;
}

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  double middle() const { return (low + high) / 2; }
};

Extent ExtentAlong(const Eigen::Vector3d& direction, const std::vector<Eigen::Vector3d>& points) {
  Extent extent;
  for (const Eigen::Vector3d& point : points) {
    extent.low = std::min(extent.low, direction.dot(point));
    extent.high = std::max(extent.high, direction.dot(point));
  }
  return extent;
}

void MakeClosedAtZero(RobotJoint& finger, bool opens) {
  if (opens && finger.lower == 0) return;
  const double range = finger.upper - finger.lower;
  finger.parent_from_joint =
      finger.parent_from_joint * Translation(finger.axis * (opens ? finger.lower : finger.upper));
  if (!opens) finger.axis = -finger.axis;
  finger.lower = 0;
  finger.upper = range;
}

}  // namespace

void NormaliseFingers(RobotDescription& robot) {
  const std::size_t left = LeftOf(robot);
  for (const std::size_t side : {0U, 1U}) {
    RobotJoint& finger = robot.joints[left + side];
    const RobotJoint& other = robot.joints[left + 1 - side];
    const Eigen::Vector3d opening = OpeningOf(finger);
    const auto own = PointsOf(robot, left + side, (finger.lower + finger.upper) / 2);
    const auto others = PointsOf(robot, left + 1 - side, (other.lower + other.upper) / 2);
    const bool seen = !own.empty() && !others.empty();
    MakeClosedAtZero(finger, !seen || ExtentAlong(opening, own).middle() >=
                                          ExtentAlong(opening, others).middle());
  }
}

bool OrderFingers(RobotDescription& robot) {
  RobotJoint& left = robot.joints[LeftOf(robot)];
  RobotJoint& right = robot.joints[LeftOf(robot) + 1];
  const double along = OpeningOf(left).dot(robot.tcp.body_from_frame.linear().col(1));
  if (std::abs(along) < 0.99) return false;
  if (along > 0) return true;
  std::swap(left, right);
  const int left_index = static_cast<int>(LeftOf(robot));
  for (auto* pieces : {&robot.visuals, &robot.hulls}) {
    for (RobotPiece& piece : *pieces) {
      if (piece.joint >= left_index) piece.joint = 2 * left_index + 1 - piece.joint;
    }
  }
  return true;
}

std::optional<RigidTransform> GuessedTcp(const RobotDescription& robot) {
  const std::size_t left = LeftOf(robot);
  const auto left_points = PointsOf(robot, left, 0);
  const auto right_points = PointsOf(robot, left + 1, 0);
  const auto hand_points = PointsOf(robot, left - 1, 0);
  if (left_points.empty() || right_points.empty()) return std::nullopt;
  const Eigen::Vector3d y = OpeningOf(robot.joints[left]);
  Eigen::Vector3d z = Eigen::Vector3d::Zero();
  double farthest = 0;
  for (const int axis : {0, 1, 2}) {
    for (const double way : {1.0, -1.0}) {
      const Eigen::Vector3d raw = way * robot.hand.body_from_frame.linear().col(axis);
      if (std::abs(raw.dot(y)) > 0.3) continue;
      const Eigen::Vector3d direction = (raw - raw.dot(y) * y).normalized();
      const double hand_end = hand_points.empty()
                                  ? direction.dot(robot.hand.body_from_frame.translation())
                                  : ExtentAlong(direction, hand_points).high;
      const double reach = ExtentAlong(direction, left_points).high - hand_end;
      if (reach <= farthest) continue;
      farthest = reach;
      z = direction;
    }
  }
  if (farthest <= 0) return std::nullopt;
  const Eigen::Vector3d x = y.cross(z);
  const double tip = ExtentAlong(z, left_points).high;
  std::vector<Eigen::Vector3d> tips;
  for (const Eigen::Vector3d& point : left_points) {
    if (z.dot(point) > tip - kTipLength) tips.push_back(point);
  }
  const double between = (ExtentAlong(y, left_points).low + ExtentAlong(y, right_points).high) / 2;
  RigidTransform tcp = RigidTransform::Identity();
  tcp.linear() << x, y, z;
  tcp.translation() = ExtentAlong(x, tips).middle() * x + between * y + (tip - kTipBeyondTcp) * z;
  return tcp;
}

}  // namespace doorforge::internal
