// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/physics/robot_model.h"

namespace doorforge::internal {

/// Postures with a level hand that faces x before the robot, from which inverse kinematics finds
/// its way to a handle. An arm built like Franka's has four, known by their angles; for any other
/// they are searched: far from limits, the links over the floor, for each of four rolls of the
/// hand. Fingers open, base in the middle. Deterministic.
std::vector<JointVector> LevelPostures(const RobotModel& robot);

}  // namespace doorforge::internal
