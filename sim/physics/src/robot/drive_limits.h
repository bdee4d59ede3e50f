// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/physics/robot_model.h"

namespace doorforge::internal {

/// The greatest torques [N m] and forces [N] that the joints' drives may use, such that a hand that
/// does not give way is pressed with no more than a force, along the sliders, where every joint has
/// to hold against it. A joint's is what that force, and a moment on an arm of 0.2 m, ask of it
/// through the column of the hand's Jacobian (Siciliano et al., Robotics, 2009, 3.8), and
/// what it takes to move its own inertia; never more than its effort.
class DriveLimits {
 public:
  /// @param robot Must outlive this.
  /// @param masses Of the joints' bodies as the world simulates them.
  /// @param hand_force_n Positive.
  DriveLimits(const RobotModel& robot, const RigidTransform& world_from_base,
              std::vector<MassProperties> masses, double hand_force_n)
      : robot_(robot),
        world_from_base_(world_from_base),
        masses_(std::move(masses)),
        hand_force_n_(hand_force_n) {}

  ArmVector At(const JointVector& position) const;

 private:
  const RobotModel& robot_;
  RigidTransform world_from_base_;
  std::vector<MassProperties> masses_;
  double hand_force_n_;
};

}  // namespace doorforge::internal
