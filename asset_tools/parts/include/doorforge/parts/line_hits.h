// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

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

/// HitsAlong(mesh, 0, at) for many lines of one mesh: the same results, without looking at every
/// triangle.
class LinesAlongX {
 public:
  explicit LinesAlongX(const TriangleMesh& mesh);

  std::optional<LineHits> At(const Eigen::Vector2d& at) const;

 private:
  static constexpr int kCells = 48;  // along y and along z

  /// First and last cell of a triangle's bounds along y and along z.
  struct Cover {
    int first_row, last_row, first_column, last_column;
  };

  int CellOf(double coordinate, int axis) const;
  Cover CoverOf(std::size_t triangle) const;

  std::vector<std::array<Eigen::Vector3d, 3>> triangles_;
  std::vector<Eigen::AlignedBox2d> boxes_;  // of each triangle
  Eigen::AlignedBox2d bounds_;
  Eigen::Vector2d cells_per_m_;
  std::vector<std::uint32_t> first_of_;  // of each cell in over_, and one past the last
  std::vector<int> over_;                // triangles over each cell, cell by cell
};

}  // namespace doorforge::internal
