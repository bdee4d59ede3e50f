// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/core/closed_mesh.h"

#include "solid_rows.h"

namespace doorforge {

/// How far each cell of a grid is from the solid inside a closed mesh: centre to centre of the
/// nearest cell that holds a piece of the solid. Overlapping pieces count as their union.
class DistanceGrid {
 public:
  /// The grid covers the mesh's bounds.
  DistanceGrid(const ClosedMesh& mesh, double cell_m);

  const Grid& grid() const { return grid_; }
  float DistanceAt(int i, int j, int k) const { return distance_m_[grid_.IndexOf(i, j, k)]; }
  /// The largest in the row (j, k) along x.
  float LargestInRow(int j, int k) const { return row_largest_m_[grid_.IndexOf(0, j, k) / Nx()]; }

 private:
  void MarkInside(const TriangleMesh& mesh);
  void MarkSurface(const TriangleMesh& mesh);
  void SpreadDistances();
  std::size_t Nx() const { return static_cast<std::size_t>(grid_.size.x()); }

  Grid grid_;
  std::vector<float> distance_m_;
  std::vector<float> row_largest_m_;
};

}  // namespace doorforge
