// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "doorforge/physics/robot_model.h"

namespace doorforge::internal {

/// Drives as measured to work in docs/design/simulation.md; all simulators have them.
inline constexpr double kArmPositionGain = 0.2;    ///< Of what is left, in a step.
inline constexpr double kFingerSpeed = 0.1;        ///< Closing and opening [m/s].
inline constexpr double kFingerOpeningGain = 0.3;  ///< Of what is left, in a step.
inline constexpr double kFingerOpenForce = 100;    ///< [N]

/// Principal moments of a joint's body below this are raised to it.
double LeastInertiaOf(const RobotJoint& joint);

/// The masses of the joints' bodies as they are simulated.
std::vector<MassProperties> SimulatedMasses(const RobotModel& robot);

/// Friction of each joint's body, which is multiplied with what it touches.
std::vector<double> FrictionsOf(const RobotModel& robot, double finger_friction);

/// "platform", "link3", "hand", "finger".
std::string NameOfBody(const RobotModel& robot, int joint);

}  // namespace doorforge::internal
