// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// The scene as this robot can play it: a robot on a fixed base is stood where it reaches the
/// handle, turned and along an opening of 45 degrees, as far as there is such a place; beside the
/// swinging leaf, facing the door within 35 degrees. Other robots stay where the scene has them.
/// Every scene gets the robot's identity.
///
/// Privileged: uses the door's geometry. Deterministic.
Scene SceneFor(const RobotModel& robot, Scene scene, const DoorAsset& door);

}  // namespace doorforge
