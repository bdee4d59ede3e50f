// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/hand_trajectory.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "doorforge/core/error.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {
namespace {

constexpr double kOffsetUnit = 0.1;    // [m]
constexpr double kTurnMPerRad = 0.15;  // how long a turn is
constexpr std::size_t kGraspNumbers = 6;

Eigen::Vector3d TurnBetween(const RigidTransform& from, const RigidTransform& to) {
  return RotationVector(to.linear() * from.linear().transpose());
}

double LengthBetween(const RigidTransform& from, const RigidTransform& to) {
  return std::hypot((to.translation() - from.translation()).norm(),
                    kTurnMPerRad * TurnBetween(from, to).norm());
}

RigidTransform Between(const RigidTransform& from, const RigidTransform& to, double share) {
  const Eigen::Vector3d turn = TurnBetween(from, to);
  const double angle = turn.norm();
  RigidTransform pose = from;
  pose.translation() += share * (to.translation() - from.translation());
  if (angle > 0)
    pose.linear() = RotationAbout(turn / angle, share * angle).linear() * from.linear();
  return pose;
}

}  // namespace

std::vector<float> ToNumbers(const HandTrajectory& trajectory) {
  std::vector<float> numbers;
  for (Eigen::Index row = 0; row < 2; ++row)
    for (Eigen::Index column = 0; column < 3; ++column)
      numbers.push_back(static_cast<float>(trajectory.world_from_hand_rotation(row, column)));
  for (const HandWaypoint& waypoint : trajectory.waypoints) {
    for (const double x : waypoint.offset_m) numbers.push_back(static_cast<float>(x / kOffsetUnit));
    for (const double x : waypoint.turn_rad) numbers.push_back(static_cast<float>(x));
  }
  return numbers;
}

HandTrajectory TrajectoryFromNumbers(std::span<const float> numbers) {
  Require(numbers.size() >= kGraspNumbers && numbers.size() % 6 == 0, ErrorCode::kInvalidArgument,
          "trajectory: " + std::to_string(numbers.size()) +
              " numbers, expected 6 for the hand and 6 a waypoint");
  for (const float number : numbers)
    Require(std::isfinite(number), ErrorCode::kInvalidArgument,
            "trajectory: a number is not finite");
  ActionVector grasp{};
  std::copy_n(numbers.begin(), kGraspNumbers, grasp.begin() + 3);
  HandTrajectory trajectory;
  trajectory.world_from_hand_rotation = FromVector(grasp).world_from_hand_rotation;
  for (std::size_t i = kGraspNumbers; i < numbers.size(); i += 6) {
    const Eigen::Vector3f offset(numbers[i], numbers[i + 1], numbers[i + 2]);
    const Eigen::Vector3f turn(numbers[i + 3], numbers[i + 4], numbers[i + 5]);
    trajectory.waypoints.push_back({kOffsetUnit * offset.cast<double>(), turn.cast<double>()});
  }
  return trajectory;
}

std::vector<HandWaypoint> EvenWaypoints(const std::vector<RigidTransform>& world_from_hand,
                                        int count) {
  const RigidTransform& start = world_from_hand.front();
  std::vector<double> length = {0};  // up to each pose
  for (std::size_t i = 1; i < world_from_hand.size(); ++i)
    length.push_back(length.back() + LengthBetween(world_from_hand[i - 1], world_from_hand[i]));
  std::vector<HandWaypoint> waypoints;
  std::size_t next = 0;
  for (int k = 1; k <= count; ++k) {
    const double at = length.back() * k / count;
    while (next + 1 < length.size() && length[next] < at) ++next;
    RigidTransform pose = world_from_hand[next];
    if (next > 0 && length[next] > length[next - 1])
      pose = Between(world_from_hand[next - 1], world_from_hand[next],
                     std::min(1.0, (at - length[next - 1]) / (length[next] - length[next - 1])));
    waypoints.push_back({pose.translation() - start.translation(), TurnBetween(start, pose)});
  }
  return waypoints;
}

}  // namespace doorforge
