// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/schemas/cloud.h"
#include "doorforge/schemas/door_facts.h"

namespace doorforge {

/// UniDoorManip's proprioception (reference code, 32 numbers): 11 joint positions normalised to
/// [-1, 1] by their limits (slider x, slider y, 7 arm joints, 2 fingers), 11 joint velocities
/// [m/s, rad/s], base xyz [m], hand xyz [m], hand quaternion xyzw; all in the world.
using Proprioception = std::array<float, 32>;

/// The policies' state (18 numbers): normalised positions of 2 sliders and 7 arm joints, then their
/// velocities.
using PolicyState = std::array<float, 18>;
PolicyState PolicyStateOf(const Proprioception& proprioception);
Eigen::Vector3f BasePositionOf(const Proprioception& proprioception);
Eigen::Vector3f HandPositionOf(const Proprioception& proprioception);
/// Rotation world_from_hand.
Eigen::Matrix3d HandRotationOf(const Proprioception& proprioception);
/// Left, right, normalised: -1 is closed, 1 wide open.
Eigen::Vector2f FingerOpeningsOf(const Proprioception& proprioception);

/// What the simulator knows and a robot would not; only rule-based experts may read it.
struct PrivilegedState {
  double hinge_rad = 0;
  double handle_rad = 0;
  RigidTransform world_from_handle = RigidTransform::Identity();
  RigidTransform world_from_hand = RigidTransform::Identity();
  Eigen::Vector3d hinge_origin_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d hinge_axis_in_world = Eigen::Vector3d::UnitZ();  ///< Positive turn opens.
  Eigen::Vector3d handle_origin_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d handle_axis_in_world = Eigen::Vector3d::UnitX();  ///< Positive turn unlocks.
  /// Hand pose in the handle's frame as it was when the fingers had closed.
  RigidTransform handle_from_hand_at_grasp = RigidTransform::Identity();
  DoorFacts door;
};

/// What a policy sees at a decision point (every 1/6 s).
struct Observation {
  LabelledCloud cloud;  ///< 4096 points; point 0 is the visible point nearest to the hand.
  Proprioception proprioception{};
  PrivilegedState privileged;
};

/// What a policy asks for (9 numbers): the next hand position minus the current one, in the world,
/// and the first two rows of the absolute target rotation world_from_hand.
struct Action {
  Eigen::Vector3d position_delta_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d world_from_hand_rotation = Eigen::Matrix3d::Identity();
};

using ActionVector = std::array<float, 9>;
ActionVector ToVector(const Action& action);
/// Orthonormalises the six rotation numbers (Gram-Schmidt on the two rows, third by cross product).
/// Rows that are parallel or zero give the nearest valid rotation; numbers that are not finite
/// throw Error(kInvalidArgument).
Action FromVector(const ActionVector& vector);

/// Gives these numbers without rounding to float.
using ActionNumbers = std::array<double, 9>;
ActionNumbers ToNumbers(const Action& action);
/// Does as FromVector(), but rows that are orthonormal to 1e-12 stay as they are: ToNumbers() of an
/// action that FromVector() or FromNumbers() gave comes back with the same bits.
Action FromNumbers(const ActionNumbers& numbers);

/// Experts and trained networks alike. One instance serves one episode at a time.
class Policy {
 public:
  virtual ~Policy() = default;
  /// Called once before an episode's first Act().
  virtual void Reset() {}
  virtual Action Act(const Observation& observation) = 0;
  /// Whether Act() reads the cloud. One that does not may be given an empty cloud.
  virtual bool UsesPointCloud() const { return true; }
  /// Whether Act() reads the colours of the cloud's points, which must have some then.
  virtual bool UsesColors() const { return false; }
};

}  // namespace doorforge
