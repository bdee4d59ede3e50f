// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <Eigen/Geometry>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"

namespace doorforge::internal {

/// A convex piece for questions about distances, in the frame of its owner.
struct ProbeHull {
  std::unique_ptr<btConvexHullShape> shape;
  Eigen::AlignedBox3d box;
};

/// @param margin_m How much the piece is thickened all around.
ProbeHull MakeProbeHull(const TriangleMesh& mesh, const RigidTransform& owner_from_mesh,
                        double margin_m);

/// The nearest points of two pieces, or the deepest where they overlap.
struct Separation {
  double distance = std::numeric_limits<double>::infinity();  ///< Negative: depth of the overlap.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();            ///< On `fixed`, in its owner's frame.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();           ///< It leads out of `fixed` there.
};
Separation Separate(const ProbeHull& moving, const RigidTransform& fixed_from_moving,
                    const ProbeHull& fixed);

}  // namespace doorforge::internal
