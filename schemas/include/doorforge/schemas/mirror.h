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

/// The same in a level mirror, the plane z = 0 of the world: a handle that unlocks as its lever is
/// lifted is the mirror image of one that unlocks as it goes down, and a knob that turns one way of
/// one that turns the other. Gravity is not mirrored, so this is for hands that hold something.
/// An action's rotation must be an absolute target here.
Proprioception MirroredUpright(const Proprioception& proprioception);
ActionVector MirroredUpright(const ActionVector& action);
LabelledCloud MirroredUpright(LabelledCloud cloud);

}  // namespace doorforge
