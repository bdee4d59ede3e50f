// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Geometry>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// Returns the mesh in the frame that `to_from_mesh` leads to; the triangles stay as they are.
TriangleMesh Transformed(TriangleMesh mesh, const RigidTransform& to_from_mesh);

/// Returns the nearest float of the number, of two the even one, as files hold it; every build
/// returns the same. Two casts in a loop, or Eigen's, do not: GCC 12 may take them for nothing.
double RoundedToFloat(double number);

/// Returns the point with each coordinate rounded so.
Eigen::Vector3d RoundedToFloat(const Eigen::Vector3d& point);

/// Returns the mesh with its coordinates rounded so, as the canonical mesh files hold them.
TriangleMesh RoundedToFloat(TriangleMesh mesh);

/// Returns the triangles of all meshes as one mesh, in order; no vertices are welded.
TriangleMesh Merged(std::span<const TriangleMesh> meshes);

/// Returns the box about all vertices, used by a triangle or not; it is empty if there are none.
Eigen::AlignedBox3d BoundsOf(const TriangleMesh& mesh);

}  // namespace doorforge
