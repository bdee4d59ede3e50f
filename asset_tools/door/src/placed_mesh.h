// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Geometry>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"

namespace doorforge::internal {

TriangleMesh Placed(TriangleMesh mesh, const RigidTransform& to_from_mesh);

/// Coordinates as the canonical mesh files hold them.
TriangleMesh RoundedToFloat(TriangleMesh mesh);

TriangleMesh JoinedMeshes(std::span<const TriangleMesh> meshes);

/// Of all vertices; empty without any.
Eigen::AlignedBox3d BoundsOf(const TriangleMesh& mesh);

}  // namespace doorforge::internal
