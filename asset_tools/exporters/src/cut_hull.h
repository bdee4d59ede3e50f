// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"

namespace doorforge::internal {

/// A box that is turned and placed.
struct PlacedBox {
  RigidTransform frame_from_box = RigidTransform::Identity();
  Eigen::AlignedBox3d bounds;  ///< In the box's own frame.
};

/// What a plane leaves of a convex mesh: the side where normal . x < distance. Closed and oriented
/// as the mesh was; empty if nothing is left. A vertex within 1e-7 m of the plane counts as beyond;
/// vertices within 1e-6 m become one, and no triangle has two corners in one point.
TriangleMesh CutByPlane(const TriangleMesh& hull, const Eigen::Vector3d& normal, double distance);

/// Convex pieces that together fill the hull without the box, six at most; the hull itself if they
/// do not meet. Pieces thinner than 0.5 mm along one of the box's axes are left out.
std::vector<TriangleMesh> WithoutBox(const TriangleMesh& hull, const PlacedBox& box);

}  // namespace doorforge::internal
