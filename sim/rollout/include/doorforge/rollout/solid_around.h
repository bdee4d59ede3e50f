// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <Eigen/Core>

#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// What of the closed door a point in the world is inside of: "frame", "leaf" or "handle"; empty:
/// nothing.
std::string_view SolidAround(const Eigen::Vector3d& point_m, const Scene& scene,
                             const DoorAsset& door);

/// The name of the robot's piece that a point in the world is inside of; empty: none.
std::string_view SolidAround(const Eigen::Vector3d& point_m, const RobotModel& robot,
                             const RobotPose& pose);

}  // namespace doorforge
