// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include "doorforge/rollout/grasp_plan.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/schemas/cloud.h"

namespace doorforge {

/// A grasp that somebody chose by looking at the closed door.
struct GraspCommand {
  LabelledCloud cloud;                                  ///< What was seen; point 0 is the contact.
  Eigen::Vector3d contact_m = Eigen::Vector3d::Zero();  ///< In the world, on the surface seen.
  Eigen::Matrix3d world_from_hand_rotation = Eigen::Matrix3d::Identity();
  /// How the arm gets there, of whoever has planned that as well; without it, PlanReach() does.
  std::optional<GraspPlan> plan = std::nullopt;
  /// Whether the hand has to arrive and both pads to touch the handle before the episode goes on;
  /// else one pad is enough, to see what comes of it.
  bool both_pads = false;
};

/// Chooses where the hand takes hold, once, before the robot moves, from all that the simulator
/// knows. A GraspPolicy, which sees what a robot would, becomes one by GraspFromPolicy.
class SnapshotGraspPolicy {
 public:
  virtual ~SnapshotGraspPolicy() = default;
  /// Nothing where no point to take hold of is in view.
  virtual std::optional<GraspCommand> Choose(const SceneSnapshot& snapshot) = 0;
};

/// How far beyond the contact point the tool centre goes along the hand's z: with the pads' middle
/// there, they hold what lies behind a surface point that a camera sees.
inline constexpr double kGraspInsertion = 0.012;  // [m]

}  // namespace doorforge
