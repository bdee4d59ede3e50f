// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

namespace doorforge {

/// A triangle of a surface: corners with the same number are one vertex, at one point.
struct CornerTriangle {
  std::array<int, 3> corners;
  std::array<Eigen::Vector3d, 3> points;
};

/// Whether its points lie on one line. Exact.
bool IsLine(const CornerTriangle& triangle);

/// Whether two triangles, none of which is a line, share more than their common corners and edge:
/// they cross, touch, are folded onto each other or are the same. Exact.
bool TrianglesCross(const CornerTriangle& s, const CornerTriangle& t);

}  // namespace doorforge
