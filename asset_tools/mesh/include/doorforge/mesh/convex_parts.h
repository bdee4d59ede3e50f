// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "doorforge/core/closed_mesh.h"

namespace doorforge {

struct ConvexPartsConfig {
  int max_parts = 24;
  double max_concavity_m = 0.005;  ///< How far a part may protrude beyond the mesh, as a grid of
                                   ///< cells of a third of it tells.
  double max_protrusion_m = 0;     ///< It is measured like the other; 0: it was not.
  int max_vertices = 64;           ///< A part has at most so many, at least 4.
  int max_grid_cells = 4'000'000;  ///< Cells of the grid that the search works on.
  /// What may be looked at, in millions of steps of some ten nanoseconds, before the parts that
  /// were found have to do; 0: anything. It is counted, not timed.
  int max_search = 0;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("max_parts", self.max_parts);
    visit("max_concavity_m", self.max_concavity_m);
    visit("max_protrusion_m", self.max_protrusion_m);
    visit("max_vertices", self.max_vertices);
    visit("max_grid_cells", self.max_grid_cells);
    visit("max_search", self.max_search);
  }
};

/// Convex pieces that together stand for the mesh in collisions.
///
/// The mesh is cut by planes along the axes, always the piece with the deepest concavity first,
/// until the hull of every piece protrudes beyond the mesh by no more than `max_concavity_m` or
/// `max_parts` are reached; pieces whose common hull keeps that bound are joined again. So an
/// opening or a finger gap wider than twice the concavity stays free. Then the surface of every
/// hull is measured, and what protrudes by more than `max_protrusion_m` is cut further while parts
/// are left. A mesh on which `max_search` was used up keeps what was found by then: of shapes with
/// more walls than parts a second search from the beginning, and cuts by what was measured, mostly
/// gain little. Each part is a closed convex mesh with at most `max_vertices` vertices, outward
/// orientation; a hull with more is reduced to those that leave the smallest rest outside.
/// Overlapping pieces of the mesh count as their union. Deterministic. Measure the result with
/// MeasureConvexParts().
///
/// @throws Error(kInvalidConfig) on a config value out of range; Error(kFormat) as CheckWork()
/// does.
std::vector<TriangleMesh> ConvexParts(const ClosedMesh& mesh, const ConvexPartsConfig& config);

/// How well parts stand for a mesh, from sampled points.
struct ConvexPartsFit {
  double protrusion_m = 0;  ///< Largest distance from a point of a part's surface that is outside
                            ///< the mesh to the mesh.
  double uncovered_m = 0;   ///< Largest distance from a point of the mesh's surface that is outside
                            ///< all parts to the nearest part.
};

/// Deterministic. Throws Error(kInvalidArgument) if there is no part, or one is not closed and
/// convex.
ConvexPartsFit MeasureConvexParts(const ClosedMesh& mesh, std::span<const TriangleMesh> parts);

/// Convex hull, closed and oriented outwards, coplanar points left out. Throws
/// Error(kInvalidArgument) if the points lie in one plane, or one is not finite.
TriangleMesh ConvexHull(std::span<const Eigen::Vector3d> points);

}  // namespace doorforge
