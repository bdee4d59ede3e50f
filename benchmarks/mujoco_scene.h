// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// The scene as MuJoCo takes it (MJCF, hulls inline): the same bodies, masses, least inertias,
/// hulls, frictions, joint limits and time step; position drives with the same effort on the arm, a
/// force on the fingers, which are coupled; handle spring, and the latch's effort as a hinge that
/// is kept shut by its own stop. Contacts between robot and door only. Actuators: one a joint, in
/// the order of the robot's joints.
std::string MujocoScene(const Scene& scene, const DoorAsset& door, const RobotModel& robot);

}  // namespace doorforge
