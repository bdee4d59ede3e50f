// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>
#include <string>

#include <Eigen/Core>

namespace doorforge {

/// No vertex of a part or door lies farther from its origin along an axis [m]. What does is damage
/// or a wrong unit, and would cost memory and time by its extent.
inline constexpr double kFarthestVertexM = 100;

/// Whether all three coordinates are numbers and within kFarthestVertexM.
inline bool IsWithinReach(const Eigen::Vector3d& vertex) {
  // written so that what is no number fails
  return std::abs(vertex.x()) <= kFarthestVertexM && std::abs(vertex.y()) <= kFarthestVertexM &&
         std::abs(vertex.z()) <= kFarthestVertexM;
}

/// "a vertex at (2000, 0, 5) m, allowed are coordinates up to 100 m; ...": of one that is not.
std::string BeyondReach(const Eigen::Vector3d& vertex);

/// Throws Error(kFormat), which begins with `name` and counts from vertex 1, unless all vertices
/// are within reach.
void RequireWithinReach(std::span<const Eigen::Vector3d> vertices, const std::string& name);

}  // namespace doorforge
