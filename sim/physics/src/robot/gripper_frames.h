// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "doorforge/physics/robot_model.h"

namespace doorforge::internal {

/// Makes both fingers closed at 0 and open at their upper limit, whatever the URDF's convention:
/// what opens is told from the fingers' shapes.
void NormaliseFingers(RobotDescription& robot);

/// Puts the finger that opens along the tool's y first. Returns false if neither does within 8
/// degrees.
bool OrderFingers(RobotDescription& robot);

/// The tool centre by the shapes of hand and fingers: y is where the left finger opens to, z the
/// axis of the hand link along which the fingers stand out farthest, the origin midway between the
/// closed pads and 8.5 mm before the tips, as on Franka's hand. Nothing where hand and fingers do
/// not show it.
std::optional<RigidTransform> GuessedTcp(const RobotDescription& robot);

}  // namespace doorforge::internal
