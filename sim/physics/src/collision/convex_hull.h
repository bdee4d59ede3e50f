// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge::internal {

/// Whether no vertex lies more than a hair (1e-6 of the size) outside of any triangle.
bool IsConvex(const TriangleMesh& mesh);

/// The convex hull, of at most `most_corners` of the points: where there are more corners, those
/// that are farthest in evenly spread directions stay. Empty where the points have no volume.
TriangleMesh ConvexHullOf(const std::vector<Eigen::Vector3d>& points, std::size_t most_corners);

}  // namespace doorforge::internal
