// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/physics/load_robot.h"

#include "robot_tree.h"

namespace doorforge::internal {

/// The part of the URDF from the hand's link on: what stays of a robot whose hand flies. Adds a
/// fault for each joint below the hand that moves and is no finger, and for a tool centre that is
/// cut off.
UrdfModel HandAlone(const UrdfModel& urdf, const RobotRoles& roles, const RobotOptions& options,
                    RobotFaults& faults);

/// The hand on sliders x, y and z and turns yaw, pitch and roll, which become the base of `roles`.
UrdfModel OnFlyingBase(UrdfModel hand, RobotRoles& roles);

/// Lays the axes of the three turns so that with all joints at 0 the tool points along the root's
/// x, its y along the root's y, and roll turns about the approach.
void PointAhead(RobotDescription& robot);

}  // namespace doorforge::internal
