// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include "doorforge/physics/door_world.h"

#include "robot/robot_body.h"
#include "world/door_body.h"

namespace doorforge::internal {

/// What the solver's contact points say after a step of `time_step_s`.
DoorContacts ReportContacts(btCollisionDispatcher& dispatcher, const RobotBody& robot,
                            const DoorBody& door, double time_step_s);

}  // namespace doorforge::internal
