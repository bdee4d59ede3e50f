// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// One action and what it led to: all that a reward may look at.
struct Transition {
  PrivilegedState before;
  PrivilegedState after;
  Action action;  ///< The action as it was carried out.
};

/// What one action at the stage "open" is worth: the angle that the hinge gained by it [rad],
/// negative where the door fell back (UniDoorManip, Section 4).
double OpeningReward(const Transition& transition);

/// What one action at the stage "handle" is worth: the angle that the handle gained by it [rad].
double HandleReward(const Transition& transition);

/// What a grasp is worth: the angle of the door in the end, at least 0 [rad].
double GraspRating(const PrivilegedState& end);

/// One of these by the stage. EpisodeStepper gives it for each step, and records of episodes hold
/// it as Decision::angle_gain_rad, the target of the critics: whoever changes a reward changes it
/// there.
double RewardOf(Stage stage, const Transition& transition);

}  // namespace doorforge
