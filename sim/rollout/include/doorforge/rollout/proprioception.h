// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/physics/door_world.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// Which joint of the robot each of the 11 joint places of Proprioception and of JointState holds;
/// -1: none, the place is 0.
using ProprioceptionPlaces = std::array<int, kRobotJointCount>;

/// Whether the 32 numbers are defined for the robot: seven arm joints, on sliders or a fixed base
/// (which stands for sliders at rest), or a flying hand.
bool HasProprioception(const RobotModel& robot);

/// Two sliders, seven arm joints, two fingers; without sliders their places are empty; of a flying
/// hand the places of the sliders and of the first four arm joints have its six joints.
/// Throws Error(kInvalidArgument) for a robot without.
ProprioceptionPlaces ProprioceptionPlacesOf(const RobotModel& robot);

/// UniDoorManip's 32 numbers, see Proprioception in policy.h. The base is the sliders' fixed root.
/// Throws Error(kInvalidArgument) for a robot without, and for a state of another robot.
Proprioception ProprioceptionOf(const RobotModel& robot, const WorldState& state,
                                const RigidTransform& world_from_base);

}  // namespace doorforge
