// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/door_asset.h"

#include "page_content.h"

namespace doorforge::internal {

/// The built-in robot's hand about a grasp: {"pieces": [{"mesh", "color"}]} in the grasp's frame,
/// the fingers' pads at the sides of the grasp's box.
PageContent::Json GripperForView(const RobotModel& robot, const Eigen::Vector3d& half_extent_m,
                                 PageContent& content);

}  // namespace doorforge::internal
