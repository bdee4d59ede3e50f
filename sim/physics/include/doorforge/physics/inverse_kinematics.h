// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/physics/robot_model.h"

namespace doorforge {

/// Damped least squares (Wampler 1986) on the joints that carry the hand.
struct InverseKinematicsConfig {
  double damping = 0.05;
  double gain = 0.5;                  ///< Part of the error that one step removes, in (0, 1].
  double max_position_step_m = 0.05;  ///< Larger errors are shortened to this.
  double max_rotation_step_rad = 0.2;
  double posture_gain = 0.01;      ///< Pull of the arm joints towards the posture, per step.
  double limit_margin_rad = 0.02;  ///< A joint this close to a limit does not move towards it.
};

struct InverseKinematicsGoal {
  RigidTransform world_from_tcp = RigidTransform::Identity();
  /// Where the arm joints are drawn to as far as the goal leaves freedom; base joints are free.
  JointVector posture;
};

/// One step from `position` towards the goal. A joint that would run into its limit is frozen and
/// the step solved again for the others, so a saturated wrist does not leave a permanent error.
/// Fingers keep their position. The result lies inside the limits.
JointVector StepTowards(const RobotModel& robot, const RigidTransform& world_from_base,
                        const InverseKinematicsGoal& goal, const JointVector& position,
                        const InverseKinematicsConfig& config = {});

struct InverseKinematicsSolution {
  JointVector position;
  double position_error_m = 0;
  double rotation_error_rad = 0;

  bool Reached() const { return position_error_m < 2e-3 && rotation_error_rad < 0.02; }
};

/// Repeats StepTowards() from `start` until the goal is met within 0.5 mm and 2 mrad, at most 300
/// times.
InverseKinematicsSolution SolveInverseKinematics(const RobotModel& robot,
                                                 const RigidTransform& world_from_base,
                                                 const InverseKinematicsGoal& goal,
                                                 const JointVector& start);

}  // namespace doorforge
