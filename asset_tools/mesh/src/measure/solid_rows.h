// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// A grid of cubic cells over a mesh; cell (i, j, k) has its centre at
/// origin + (i + 1/2, j + 1/2, k + 1/2) * cell_m.
struct Grid {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  double cell_m = 0;
  Eigen::Vector3i size = Eigen::Vector3i::Zero();

  std::size_t IndexOf(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size.y()) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size.x()) +
           static_cast<std::size_t>(i);
  }
  std::size_t count() const { return IndexOf(0, 0, size.z()); }
  /// The cell that holds the point, or the nearest one.
  Eigen::Vector3i CellAt(const Eigen::Vector3d& point) const {
    // what is not negative is rounded down as it becomes an integer, which takes less than floor()
    const Eigen::Array3d cell = ((point - origin_m) / cell_m).array();
    return cell.max(0.0).min((size.array() - 1).cast<double>()).cast<int>();
  }
  Eigen::Vector3d CenterOf(int i, int j, int k) const {
    return origin_m + cell_m * (Eigen::Vector3d(i, j, k) + Eigen::Vector3d::Constant(0.5));
  }
};

/// Where the line along x through the centres of a row of cells crosses the mesh.
struct Crossing {
  double x_m = 0;
  int winding = 0;  ///< +1 going in, -1 coming out.
};

/// The crossings of each row (j, k) with a closed mesh, sorted by x; row j + k * size.y().
/// Watertight: a line through an edge or a vertex counts each sheet once, so the windings of a row
/// add up to 0.
std::vector<std::vector<Crossing>> RowCrossings(const TriangleMesh& mesh, const Grid& grid);

/// The mesh's bounds with `margin` empty cells around.
Grid GridOver(const TriangleMesh& mesh, double cell_m, int margin);

/// The smallest cell with which GridOver() keeps to `max_cells`, but at least `cell_m`.
double CellFor(const TriangleMesh& mesh, double cell_m, int margin, int max_cells);

}  // namespace doorforge
