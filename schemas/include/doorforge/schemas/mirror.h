// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/schemas/cloud.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// What a robot with a parallel gripper would do and know in the mirror image of its scene, in the
/// plane y = 0 of the world: a door hinged right is the mirror image of one hinged left. The mirror
/// image of a hand is a hand whose fingers have changed places, so its y axis keeps the sense that
/// a hand's has. Applied twice, both give back what went in.

/// Hand and base are mirrored, the two finger openings exchanged. The mirror image of an arm with
/// seven joints is another arm, so its joints' positions and velocities, and the sliders', stay as
/// they are: only who does not read them may use this.
Proprioception MirroredSideways(const Proprioception& proprioception);

/// The rotation may be an absolute target, or a turn from the present rotation of the hand.
ActionVector MirroredSideways(const ActionVector& action);
/// The points' y changes its sign; their labels stay.
LabelledCloud MirroredSideways(LabelledCloud cloud);

}  // namespace doorforge
