// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

namespace doorforge {

/// Boxes by number, to be found by overlap while they change: a loose octree (Ulrich 2000). Each
/// box lies in one cell, at most as large as the cell and with its middle inside, so that a cell
/// twice as wide holds it.
class BoxOctree {
 public:
  /// For boxes numbered below `count` with their middles within `bounds`, which is not empty.
  BoxOctree(const Eigen::AlignedBox3d& bounds, std::size_t count);

  /// Puts the box in, or in the place of the one of this number. Middles outside of the bounds are
  /// found all the same, only slower.
  void Put(std::size_t number, const Eigen::AlignedBox3d& box);
  void Remove(std::size_t number);

  /// The numbers of the boxes that overlap or touch this one, in an order that depends on the
  /// history alone.
  void Find(const Eigen::AlignedBox3d& box, std::vector<std::size_t>& found) const;

 private:
  struct Cell {
    Eigen::Vector3d middle;
    double half = 0;                      // of its width; boxes reach up to twice as far
    std::array<std::size_t, 8> children;  // 0: none
    std::vector<std::size_t> numbers;
  };

  std::size_t CellFor(const Eigen::AlignedBox3d& box);
  std::size_t AddCell(const Eigen::Vector3d& middle, double half);

  std::vector<Cell> cells_;  // the root first; it takes whatever fits no other
  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<std::size_t> cell_of_;  // for each box; kNone where it is out
};

}  // namespace doorforge
