// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "doorforge/physics/robot_model.h"

namespace doorforge::internal {

inline constexpr double kUnreachedCost = 20;  ///< Of a pose that the arm does not get to.
inline constexpr double kTurnCheck = 0.7;     ///< [rad] of a handle's turn that is looked at.

/// Inverse kinematics of a robot that stands somewhere.
struct Reach {
  const RobotModel& robot;
  const RigidTransform& world_from_base;

  /// Moves `position` to the pose, or as near as it gets. @returns 0 where it is reached.
  double Solve(const RigidTransform& world_from_tcp, JointVector& position) const;
};

/// A grasp in some frame that is placed in the world, and the arm's way to it.
struct ReachedGrasp {
  RigidTransform frame_from_tcp = RigidTransform::Identity();
  JointVector pregrasp;
  JointVector grasp;
  double cost = std::numeric_limits<double>::infinity();
};

/// To the pose before the grasp from `start`, and from there to the grasp; the cost is what is not
/// reached.
ReachedGrasp ReachFrom(const Reach& reach, const RigidTransform& world_from_frame,
                       const RigidTransform& frame_from_tcp, const JointVector& start);

}  // namespace doorforge::internal
