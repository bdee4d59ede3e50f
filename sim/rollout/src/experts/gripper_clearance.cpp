// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/gripper_clearance.h"

#include <algorithm>
#include <array>

#include <Eigen/Geometry>

#include "doorforge/rollout/grasp_plan.h"
#include "doorforge/rollout/snapshot_grasp_policy.h"

namespace doorforge {

GripperClearance::GripperClearance(const RobotModel& robot)
    : tcp_in_hand_m_(robot.hand_from_tcp().translation()) {
  const std::array<int, 2> fingers = {robot.left_finger(), robot.right_finger()};
  JointVector open = robot.InitialPosition();
  for (const int finger : fingers) open[finger] = robot.joint(finger).upper;
  const RobotPose pose = robot.PoseAt(open, RigidTransform::Identity());
  for (const RobotPiece& piece : robot.hulls()) {
    if (piece.joint != robot.hand().joint && std::ranges::count(fingers, piece.joint) == 0)
      continue;
    const auto body = static_cast<std::size_t>(piece.joint);
    hulls_.push_back(
        HullOf(piece.mesh, pose.world_from_hand.inverse() * pose.world_from_body[body]));
  }
}

GripperClearance::Hull GripperClearance::HullOf(const TriangleMesh& mesh,
                                                const RigidTransform& hand_from_body) {
  const auto corner = [&](int vertex) {
    return hand_from_body * mesh.vertices[static_cast<std::size_t>(vertex)];
  };
  const auto count = static_cast<Eigen::Index>(mesh.triangles.size());
  Hull hull{Eigen::MatrixX3d::Zero(count, 3), Eigen::VectorXd::Zero(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3i& triangle = mesh.triangles[static_cast<std::size_t>(i)];
    const Eigen::Vector3d first = corner(triangle[0]);
    const Eigen::Vector3d normal =
        (corner(triangle[1]) - first).cross(corner(triangle[2]) - first).stableNormalized();
    hull.normals.row(i) = normal;
    hull.offsets[i] = normal.dot(first) - kGraze * normal.norm();  // none of a sliver without area
  }
  return hull;
}

bool GripperClearance::Fits(const LabelledCloud& visible, const Eigen::Vector3d& contact_m,
                            const Eigen::Matrix3d& world_from_hand_rotation) const {
  const Eigen::Vector3d hand_in_world_m =
      contact_m +
      world_from_hand_rotation * (kGraspInsertion * Eigen::Vector3d::UnitZ() - tcp_in_hand_m_);
  int met = 0;
  for (std::size_t i = 0; i < visible.label.size() && met < kBlockingPoints; ++i) {
    const Eigen::Vector3f point(visible.xyz[3 * i], visible.xyz[3 * i + 1], visible.xyz[3 * i + 2]);
    const Eigen::Vector3d at =
        world_from_hand_rotation.transpose() * (point.cast<double>() - hand_in_world_m);
    if (Passes(at)) ++met;
  }
  return met < kBlockingPoints;
}

// Clips the way of the point, as the hand comes from behind, by the planes of each hull.
bool GripperClearance::Passes(const Eigen::Vector3d& point_in_hand_m) const {
  return std::ranges::any_of(hulls_, [&](const Hull& hull) {
    double from = 0;
    double to = kPregraspDistance;
    for (Eigen::Index i = 0; i < hull.offsets.size() && from <= to; ++i) {
      const double room = hull.offsets[i] - hull.normals.row(i).dot(point_in_hand_m);
      const double slope = hull.normals(i, 2);
      if (slope > 0) {
        to = std::min(to, room / slope);
      } else if (slope < 0) {
        from = std::max(from, room / slope);
      } else if (room < 0) {
        return false;
      }
    }
    return from <= to;
  });
}

}  // namespace doorforge
