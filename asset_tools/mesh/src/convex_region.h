// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "doorforge/core/triangle_mesh.h"

#include "distance_grid.h"

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

/// Points on the triangles of a mesh, about `step_m` apart, with their corners.
std::vector<Eigen::Vector3d> PointsOn(const TriangleMesh& mesh, double step_m);

/// The cell inside a hull that is farthest from the solid.
struct Concavity {
  double depth_m = 0;
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  ///< Centre of that cell; meaningless at depth 0.
};
/// Looks at every `stride`-th row of cells along both axes across the rows.
Concavity ConcavityOf(const TriangleMesh& hull, const DistanceGrid& solid, int stride = 1);

/// Depth of the concavity where that is no more than `allowed_m`, else any depth beyond.
double DepthWithin(const TriangleMesh& hull, const DistanceGrid& solid, double allowed_m);

/// Whether no cell inside the hull is farther from the solid than `allowed_m`.
bool StaysWithin(const TriangleMesh& hull, const DistanceGrid& solid, double allowed_m);

}  // namespace doorforge
