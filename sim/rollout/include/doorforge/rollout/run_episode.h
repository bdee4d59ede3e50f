// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/physics/door_world.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/policy.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// Whether the 32 numbers are defined for the robot: seven arm joints, on sliders or a fixed base
/// (which stands for sliders at rest).
bool HasProprioception(const RobotModel& robot);

/// UniDoorManip's 32 numbers, see Proprioception in policy.h. The base is the sliders' fixed root.
/// Throws Error(kInvalidArgument) for a robot without, and for a state of another robot.
Proprioception ProprioceptionOf(const RobotModel& robot, const WorldState& state,
                                const RigidTransform& world_from_base);

/// Runs one episode: the privileged rules grasp the handle and turn it until it is "handle done"
/// (a door without a latch needs no turn); then `opening` decides every steps_per_action steps, at
/// most max_opening_actions times. These decisions are recorded.
///
/// kOpened means that the hinge passed 45 degrees while a finger's pad touched the handle within
/// the last action; a door that coasts on by itself, or that the arm has pushed on, is not opened.
/// The episode ends after the action in which the hinge passes finish_hinge_rad. `detail` has the
/// numbers: angles, grasp slip, what was touched, distance of finger and handle.
///
/// @param scene Its door_id must be `door`'s.
/// @param observer May be null: policies then see an empty cloud.
/// @throws Error(kInvalidArgument) as DoorWorld does, or if scene and door do not belong together.
///
/// Deterministic as DoorWorld is, if `opening` and `observer` are.
Episode RunEpisode(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                   Policy& opening, Observer* observer);

}  // namespace doorforge
