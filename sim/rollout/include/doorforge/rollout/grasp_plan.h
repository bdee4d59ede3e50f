// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// Where the expert takes hold of the handle, and how the arm gets there.
struct GraspPlan {
  /// Tool centre in the handle's frame.
  RigidTransform handle_from_tcp = RigidTransform::Identity();
  JointVector pregrasp;  ///< kPregraspDistance before the grasp.
  JointVector grasp;
  double cost = 0;  ///< It rates the geometry; 0 is flat, central contact of both pads.
  /// How far from the middle the fingers open on the way there [m]; without it, all the way.
  std::optional<double> fingers_open_m = std::nullopt;
  /// How far the base, if it has sliders, steps back from the door before the arm moves [m], and
  /// comes forward only when the arm has its posture.
  double step_back_m = 0;
};

inline constexpr double kPregraspDistance = 0.12;  ///< [m], back along the approach.

/// Picks the best grasp among small variations of the scene's (noisy) grasp: depth, place along the
/// handle and turn about the approach are searched, the place across is chosen so that both pads
/// touch at once. Judged by the hulls of the closed door: both pads must meet the handle, the open
/// gripper must pass; flat contact near the middle of the pads, little change and a wrist far from
/// its limits are better. If no variation satisfies all that, the least bad one is returned.
///
/// It looks at the whole way where a door is pushed by an upright handle (IsPushedUpright()), as
/// the hand has to follow the leaf past the frame: of grasps that lean by different angles, and
/// many postures, the best is one with which arm and base stay inside their limits and clear of
/// frame and leaf while the handle turns and the leaf opens to 47 degrees. The cost counts the way
/// as well. Where opened fingers do not pass, they open as far as the handle needs. That takes some
/// 0.3 s of one core more.
///
/// Privileged: uses the door's geometry. Deterministic.
GraspPlan PlanGrasp(const Scene& scene, const DoorAsset& door, const RobotModel& robot);

/// How the arm gets to a grasp that is given, well chosen or not.
struct ArmReach {
  RigidTransform world_from_tcp = RigidTransform::Identity();
  JointVector pregrasp;  ///< kPregraspDistance before the grasp.
  JointVector grasp;
};

/// The posture for a grasp, chosen by reach and by the room that the last joint has for a turn
/// either way, about the middle of its range; nothing is known of the door. The two fingers are
/// alike: the hand may arrive turned by half a turn about its approach. Deterministic.
ArmReach PlanReach(const Scene& scene, const RobotModel& robot,
                   const RigidTransform& world_from_tcp);

/// GraspPlan::cost of the best grasp near the door's own, noise and the arm's reach aside: below
/// 0.3 good; above 5 a pad finds no hold, or the open gripper is blocked. Any side and opening.
double GraspCost(const DoorAsset& door, const RobotModel& robot);

}  // namespace doorforge
