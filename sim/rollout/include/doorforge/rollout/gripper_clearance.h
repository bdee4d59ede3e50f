// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "doorforge/physics/robot_model.h"
#include "doorforge/schemas/cloud.h"

namespace doorforge {

/// Whether the open gripper reaches a grasp without passing through what a camera saw. Nothing is
/// known here of the door: what is hidden is taken to be free. Immutable; deterministic.
class GripperClearance {
 public:
  /// Takes the hulls of the robot's hand and of its fingers, opened all the way.
  explicit GripperClearance(const RobotModel& robot);

  /// The hand comes straight in, from kPregraspDistance before the grasp, see SnapshotGraspPolicy.
  ///
  /// @param visible World [m].
  /// @param contact_m, world_from_hand_rotation As in GraspAction.
  /// @returns False where at least kBlockingPoints of the points are deeper than kGraze in a hull
  ///     somewhere on the way: fewer may be noise, and what the surface grazes gives way.
  bool Fits(const LabelledCloud& visible, const Eigen::Vector3d& contact_m,
            const Eigen::Matrix3d& world_from_hand_rotation) const;

  static constexpr double kGraze = 0.003;  ///< [m]
  static constexpr int kBlockingPoints = 3;

 private:
  // A convex piece: the points x, in the hand's frame, with normals * x <= offsets.
  struct Hull {
    Eigen::MatrixX3d normals;
    Eigen::VectorXd offsets;
  };

  static Hull HullOf(const TriangleMesh& mesh, const RigidTransform& hand_from_body);
  bool Passes(const Eigen::Vector3d& point_in_hand_m) const;

  std::vector<Hull> hulls_;
  Eigen::Vector3d tcp_in_hand_m_;
};

}  // namespace doorforge
