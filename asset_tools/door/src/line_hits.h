// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge::internal {

/// Where a straight line meets a mesh.
struct LineHits {
  double first;  ///< Smallest coordinate along the line.
  double last;   ///< Largest.
};

/// The line along coordinate axis `axis` (0, 1, 2) through the two remaining coordinates, in
/// cyclic order: for axis 0 they are (y, z), for 1 (z, x), for 2 (x, y). Nothing if it misses.
std::optional<LineHits> HitsAlong(const TriangleMesh& mesh, int axis, const Eigen::Vector2d& at);

}  // namespace doorforge::internal
