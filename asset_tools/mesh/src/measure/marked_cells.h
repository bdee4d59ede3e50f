// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace doorforge {

/// Cells of a grid that are marked. Whether a box holds one is told from eight sums over boxes that
/// begin at the grid's first cell, however large it is.
class MarkedCells {
 public:
  /// `is_marked` is asked about each cell's place in the order of Grid::IndexOf().
  template <class IsMarked>
  MarkedCells(const Eigen::Vector3i& size, const IsMarked& is_marked)
      : row_(static_cast<std::size_t>(size.x()) + 1),
        layer_(row_ * (static_cast<std::size_t>(size.y()) + 1)),
        before_(layer_ * (static_cast<std::size_t>(size.z()) + 1), 0) {
    std::size_t index = 0;
    for (int k = 1; k <= size.z(); ++k) {
      for (int j = 1; j <= size.y(); ++j) {
        std::uint32_t in_row = 0;
        std::uint32_t* const sum = &before_[PlaceOf(0, j, k)];
        for (std::size_t i = 1; i < row_; ++i) {
          in_row += is_marked(index++) ? 1U : 0U;
          // modulo 2^32, where a difference that is less comes out right
          sum[i] = in_row + sum[i - row_] + sum[i - layer_] - sum[i - layer_ - row_];
        }
      }
    }
  }

  /// Whether a cell from `low` to `high`, both of the grid and among them, is marked.
  bool AnyBetween(const Eigen::Vector3i& low, const Eigen::Vector3i& high) const {
    const std::uint32_t* const below = &before_[PlaceOf(0, 0, low.z())];
    const std::uint32_t* const above = &before_[PlaceOf(0, 0, high.z() + 1)];
    const std::size_t front_left = PlaceOf(low.x(), low.y(), 0);
    const std::size_t front_right = PlaceOf(high.x() + 1, low.y(), 0);
    const std::size_t back_left = PlaceOf(low.x(), high.y() + 1, 0);
    const std::size_t back_right = PlaceOf(high.x() + 1, high.y() + 1, 0);
    const auto between = [&](std::size_t place) { return above[place] - below[place]; };
    return between(back_right) - between(back_left) - between(front_right) + between(front_left) !=
           0;
  }

 private:
  std::size_t PlaceOf(int i, int j, int k) const {
    return static_cast<std::size_t>(k) * layer_ + static_cast<std::size_t>(j) * row_ +
           static_cast<std::size_t>(i);
  }

  std::size_t row_, layer_;
  std::vector<std::uint32_t> before_;  // marked cells of lower places along every axis
};

}  // namespace doorforge
