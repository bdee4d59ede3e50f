// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// Where the robot's joints are as an episode begins: its initial posture, the arm's joints shifted
/// as the scene has it.
JointVector StartPosition(const Scene& scene, const RobotModel& robot);

/// The scene as this robot can play it: a robot on a fixed base is stood where it reaches the
/// handle, turned and along an opening of 45 degrees, as far as there is such a place; beside the
/// swinging leaf, facing the door within 35 degrees. Other robots stay where the scene has them, or
/// as many steps of 2 cm farther from the door as it takes to start outside of it.
/// Every scene gets the robot's identity.
///
/// Privileged: uses the door's geometry. Deterministic.
///
/// @throws Error(kInvalidArgument) if base or arm would start inside the door at every such place,
///     up to 0.6 m back.
Scene PlaceRobotBase(const RobotModel& robot, Scene scene, const DoorAsset& door);

}  // namespace doorforge
