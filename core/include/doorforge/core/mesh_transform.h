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

/// Returns the mesh with its coordinates rounded to floats, as the canonical mesh files hold them.
/// GCC 12 with -O2 rounds z alone: it takes the conversion of x and y to float and back for
/// nothing. With -O3, as in release builds, it does so for the last one to three vertices only. So
/// the hulls of parts differ between builds.
TriangleMesh RoundedToFloat(TriangleMesh mesh);

/// Returns the triangles of all meshes as one mesh, in order; no vertices are welded.
TriangleMesh Merged(std::span<const TriangleMesh> meshes);

/// Returns the box about all vertices, used by a triangle or not; it is empty if there are none.
Eigen::AlignedBox3d BoundsOf(const TriangleMesh& mesh);

}  // namespace doorforge
