// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// A plane with the outside on the side of its normal: normal . x <= offset inside.
struct HalfSpace {
  Eigen::Vector3d normal;
  double offset = 0;
};

/// One for each triangle with an area.
std::vector<HalfSpace> HalfSpacesOf(const TriangleMesh& hull);

/// Convex hull, or nothing where the points lie in one plane.
std::optional<TriangleMesh> HullOf(std::span<const Eigen::Vector3d> points);

/// The hull of at most `max_vertices` of the hull's vertices, chosen one by one as the farthest
/// outside of what is there.
TriangleMesh ReducedHull(const TriangleMesh& hull, int max_vertices);

double VolumeOf(const TriangleMesh& mesh);

}  // namespace doorforge
