// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/episode.h"

namespace doorforge {

/// How far hinge and handle are turned at one instant [rad].
struct DoorAngles {
  double hinge_rad = 0;
  double handle_rad = 0;
};

/// What one action at the stage "open" is worth: the angle that the hinge gained by it, negative
/// where the door fell back (UniDoorManip, Section 4).
double OpeningReward(const DoorAngles& before, const DoorAngles& after);

/// What one action at the stage "handle" is worth: the angle that the handle gained by it.
double HandleReward(const DoorAngles& before, const DoorAngles& after);

/// What a grasp is worth: the angle of the door in the end, at least 0.
double GraspRating(const DoorAngles& end);

/// One of these by the stage. EpisodeStepper gives it for each step, and records of episodes hold
/// it as Decision::score_rad, the target of the critics: whoever changes a reward changes it there.
double RewardOf(Stage stage, const DoorAngles& before, const DoorAngles& after);

}  // namespace doorforge
