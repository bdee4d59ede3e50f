// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/core/rigid_transform.h"
#include "doorforge/physics/door_world.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// Whether the 32 numbers are defined for the robot: seven arm joints, on sliders or a fixed base
/// (which stands for sliders at rest).
bool HasProprioception(const RobotModel& robot);

/// UniDoorManip's 32 numbers, see Proprioception in policy.h. The base is the sliders' fixed root.
/// Throws Error(kInvalidArgument) for a robot without, and for a state of another robot.
Proprioception ProprioceptionOf(const RobotModel& robot, const WorldState& state,
                                const RigidTransform& world_from_base);

}  // namespace doorforge
