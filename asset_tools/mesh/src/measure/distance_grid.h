// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/core/closed_mesh.h"

#include "measure/solid_rows.h"

namespace doorforge {

/// How far each cell of a grid is from the solid inside a closed mesh: centre to centre of the
/// nearest cell that holds a piece of the solid. Overlapping pieces count as their union.
class DistanceGrid {
 public:
  /// The grid covers the mesh's bounds.
  DistanceGrid(const ClosedMesh& mesh, double cell_m);

  const Grid& grid() const { return grid_; }
  float DistanceAt(int i, int j, int k) const { return distance_m_[grid_.IndexOf(i, j, k)]; }

  /// The distances of all cells lie in the order of the grid.
  const std::vector<float>& distances() const { return distance_m_; }

  /// Cubes of 2^level cells along each axis, of which block (i, j, k) begins with cell
  /// (i, j, k) * 2^level; those at the end may be smaller. Level 0 are the cells, the last is one
  /// block.
  int levels() const { return static_cast<int>(largest_m_.size()) + 1; }
  Eigen::Vector3i BlocksAt(int level) const {
    return (grid_.size.array() + (1 << level) - 1) / (1 << level);
  }
  /// The largest distance in a block.
  float LargestInBlock(int level, const Eigen::Vector3i& block) const {
    if (level == 0) return DistanceAt(block.x(), block.y(), block.z());
    const Blocks& blocks = largest_m_[static_cast<std::size_t>(level) - 1];
    return blocks.value_m[blocks.IndexOf(block.x(), block.y(), block.z())];
  }

 private:
  struct Blocks {
    Eigen::Vector3i size = Eigen::Vector3i::Zero();
    std::vector<float> value_m;

    std::size_t IndexOf(int i, int j, int k) const {
      return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size.y()) +
              static_cast<std::size_t>(j)) *
                 static_cast<std::size_t>(size.x()) +
             static_cast<std::size_t>(i);
    }
  };

  void MarkInside(const TriangleMesh& mesh);
  void MarkSurface(const TriangleMesh& mesh);
  void SpreadDistances();
  void FindLargest();

  Grid grid_;
  std::vector<float> distance_m_;
  std::vector<Blocks> largest_m_;  // from level 1 on
};

}  // namespace doorforge
