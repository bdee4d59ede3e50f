// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/schemas/cloud.h"
#include "doorforge/schemas/door_facts.h"

namespace doorforge {

/// What the simulator knows of a grasp and a robot would not; only rules may read it.
struct PrivilegedGraspState {
  /// The tool centre where the part's makers take hold of the handle, in the world: its z points
  /// along the approach.
  RigidTransform world_from_tcp = RigidTransform::Identity();
  RigidTransform world_from_handle = RigidTransform::Identity();
  DoorFacts door;
};

/// A grasp that led nowhere.
struct TriedGrasp {
  Eigen::Vector3d contact_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d world_from_hand_rotation = Eigen::Matrix3d::Identity();
};

/// What is known when a grasp is chosen: one look at the closed door before the robot comes into
/// view. The handle's labels and the approach come from the simulator, or on a robot from a mask of
/// the handle and the way that the door faces.
struct GraspObservation {
  LabelledCloud visible;  ///< Every point in view; those labelled kHandle may be taken hold of.
  /// World: straight into the leaf, which for all handles but flaps is the handle's axis.
  Eigen::Vector3d approach = -Eigen::Vector3d::UnitX();
  /// A cloud of 4096 points, beginning with the visible point nearest to a place in the world, of
  /// points within a distance of that one [m] (0: of all; farthest point sampling).
  std::function<LabelledCloud(const Eigen::Vector3d&, double)> sample;
  /// Whether the open gripper gets to a contact [m] with that rotation (world from hand) without
  /// passing through what is seen. Empty: it always does.
  std::function<bool(const Eigen::Vector3d&, const Eigen::Matrix3d&)> fits = nullptr;
  RigidTransform hand_from_tcp = RigidTransform::Identity();  ///< It is fixed by the robot.
  std::vector<TriedGrasp> tried = {};  ///< In this episode already, in order.
  /// Name the episode, for policies that draw by chance: equal names, equal draws.
  std::uint64_t seed = 0;
  std::string episode = {};  ///< "<door id>/<number>"
  PrivilegedGraspState privileged = {};
};

/// What a choice was made from, for pictures and for who asks how sure it is.
struct GraspExplanation {
  double expected_opening_rad = 0;  ///< How far the door is expected to open in the end.
  /// How much each point of the handle that was looked at is worth: a heat map.
  std::vector<float> point_xyz;       ///< [m], world, n x 3.
  std::vector<float> affordance_rad;  ///< n.
};

/// Where and how the hand takes hold.
struct GraspAction {
  /// What the choice was rated from; point 0 is the place that was rated. May be empty: who records
  /// the choice samples a cloud about the contact.
  LabelledCloud cloud;
  Eigen::Vector3d contact_m = Eigen::Vector3d::Zero();  ///< World, on the surface that is seen.
  Eigen::Matrix3d world_from_hand_rotation = Eigen::Matrix3d::Identity();
  std::optional<GraspExplanation> explanation = {};  ///< Policies that Explain() fill it in.
};

/// Chooses where and how to take hold, once in an episode. Keeps nothing between calls: equal
/// observations give equal actions. One instance serves one thread at a time.
class GraspPolicy {
 public:
  virtual ~GraspPolicy() = default;
  /// Nothing where no point to take hold of is in view.
  ///
  /// @throws Error(kInvalidArgument) on a cloud that the policy cannot use, such as one without
  ///     labels.
  virtual std::optional<GraspAction> Choose(const GraspObservation& observation) = 0;
  /// Whether its actions have an explanation.
  virtual bool Explains() const { return false; }
  /// Whether it reads the colours of points, which the cloud must have then.
  virtual bool UsesColors() const { return false; }
};

}  // namespace doorforge
