// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "doorforge/core/rigid_transform.h"

namespace doorforge {

/// Where a hand is told to be, from where it took hold.
struct HandWaypoint {
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();  ///< In the world.
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();  ///< In the world, axis times angle.
};

/// A way to take hold and all of the motion that follows, said before anything moves (VAT-MART, Wu
/// et al. 2022).
struct HandTrajectory {
  Eigen::Matrix3d world_from_hand_rotation = Eigen::Matrix3d::Identity();  ///< When it takes hold.
  std::vector<HandWaypoint> waypoints;
};

/// Numbers of a trajectory of so many waypoints: the first two rows of the rotation, then of each
/// waypoint its offset [0.1 m] and its turn [rad].
constexpr int TrajectoryNumbers(int waypoints) { return 6 + 6 * waypoints; }

std::vector<float> ToNumbers(const HandTrajectory& trajectory);
/// The inverse: rows that are not orthonormal become so, as in FromVector(). Throws
/// Error(kInvalidArgument) on another number of numbers than a trajectory has, or where one is not
/// finite.
HandTrajectory TrajectoryFromNumbers(std::span<const float> numbers);

/// So many waypoints along the way of a hand, as far from each other as the way allows, the last
/// one at its end; a turn of 1 rad is as long as 0.15 m. Between two poses the hand moves and turns
/// evenly.
///
/// @param world_from_hand From where it took hold on; at least one pose.
std::vector<HandWaypoint> EvenWaypoints(const std::vector<RigidTransform>& world_from_hand,
                                        int count);

}  // namespace doorforge
