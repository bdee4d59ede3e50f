// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>

#include "doorforge/physics/grasp_probe.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge::internal {

/// A grasp as the geometry of the closed door rates it.
struct JudgedGrasp {
  RigidTransform door_from_tcp = RigidTransform::Identity();
  double finger_position_m = 0;               ///< Of both fingers when they hold the handle.
  std::optional<double> fingers_open_m = {};  ///< As in GraspPlan.
  double cost = std::numeric_limits<double>::infinity();
};

/// How far the fingers are opened on the way to a grasp.
enum class FingerOpening {
  kWide,      ///< All the way.
  kAsNeeded,  ///< Or, where that passes better, as far as the handle needs.
};

/// The best of 125 variations of a grasp, or the first that is good enough: depth, place along the
/// handle, turn about the approach. See PlanGrasp().
JudgedGrasp SearchGrasp(const GraspProbe& probe, const DoorAsset& door, const RobotModel& robot,
                        const RigidTransform& door_from_grasp,
                        FingerOpening opening = FingerOpening::kWide);

}  // namespace doorforge::internal
