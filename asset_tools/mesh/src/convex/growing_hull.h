// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// Convex hull, closed and oriented outwards, or nothing where the points lie in one plane.
///
/// With a tolerance of zero it holds every point exactly. Else it is the hull of some of the points
/// and leaves others out by less than twice `tolerance_m`, which is how a search that measures in
/// millimetres gets by with few of the points of a round surface. Which triangles stand for a facet
/// with more than three corners depends on the order of the points; ConvexHull() gives the one
/// answer that does not. Points must be finite. Deterministic.
std::optional<TriangleMesh> GrownHull(std::span<const Eigen::Vector3d> points, double tolerance_m);

}  // namespace doorforge
