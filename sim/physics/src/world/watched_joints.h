// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "doorforge/physics/divergence_detector.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge::internal {

/// What is watched in every simulator: the robot's joints in their order, then hinge and handle.
std::vector<WatchedJoint> WatchedJointsOf(const RobotModel& model, const DoorAsset& door);

/// The most that the drive of each of the robot's joints can do [N m or N].
std::vector<double> DriveLimitsOf(const RobotModel& model);

/// What is applied to hinge and handle stays far below these [N m].
std::array<double, 2> DoorTorqueLimits(const DoorAsset& door);

}  // namespace doorforge::internal
