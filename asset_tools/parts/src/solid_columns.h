// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"

namespace doorforge::internal {

/// Where a column along y is inside the solid.
struct SolidInterval {
  double low;
  double high;
};

/// A closed mesh cut into columns along y of some frame, on a regular grid in (x, z).
class SolidColumns {
 public:
  /// What a mesh may come to: 11 m square in columns of 2 mm, and what its surface crosses. Both
  /// are far above any door, and bound the memory to some 500 MB.
  static constexpr std::int64_t kMaxColumns = 30'000'000;
  static constexpr std::int64_t kMaxCrossings = 10'000'000;

  /// Throws Error(kFormat), with the size found and the size allowed, on a mesh that would take
  /// more columns or crossings than that.
  SolidColumns(const TriangleMesh& mesh, const RigidTransform& frame_from_mesh, double cell_m);

  double cell_m() const { return cell_; }

  /// Calls visit(x, z, intervals) for every column with material in the rectangle, x by x; the
  /// intervals are a std::span<const SolidInterval>.
  template <class Visitor>
  void ForEachIn(const Eigen::Vector2d& min_xz, const Eigen::Vector2d& max_xz,
                 Visitor&& visit) const;

 private:
  /// Beyond any mesh, and far enough from the ends of the type that sums and differences fit.
  static constexpr std::int64_t kFarthestCell = std::int64_t{1} << 40;

  std::int64_t CellAtOrAbove(double coordinate) const;
  /// Sets first_... and size_...; throws where there would be too many columns.
  void LayOut(const Eigen::AlignedBox3d& bounds);

  /// Calls visit(i, k, column) for the grid cells around a box.
  template <class Visitor>
  void ForEachCellOf(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                     Visitor&& visit) const;
  std::size_t ColumnAt(std::int64_t i, std::int64_t k) const {
    return static_cast<std::size_t>((i - first_x_) * size_z_ + (k - first_z_));
  }

  double cell_;
  std::int64_t first_x_ = 0;
  std::int64_t first_z_ = 0;
  std::int64_t size_x_ = 0;
  std::int64_t size_z_ = 0;
  std::vector<SolidInterval> intervals_;  // column by column, x by x
  std::vector<std::uint32_t> first_of_;   // of each column in intervals_, and one past the last
};

inline std::int64_t SolidColumns::CellAtOrAbove(double coordinate) const {
  const double cell = std::ceil(coordinate / cell_);
  if (!(cell > -static_cast<double>(kFarthestCell))) return -kFarthestCell;  // no number, too
  if (cell >= static_cast<double>(kFarthestCell)) return kFarthestCell;
  return static_cast<std::int64_t>(cell);
}

template <class Visitor>
void SolidColumns::ForEachCellOf(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                                 Visitor&& visit) const {
  const std::int64_t end_x = std::min(CellAtOrAbove(high.x()), first_x_ + size_x_);
  const std::int64_t end_z = std::min(CellAtOrAbove(high.z()), first_z_ + size_z_);
  for (std::int64_t i = std::max(CellAtOrAbove(low.x()) - 1, first_x_); i < end_x; ++i) {
    for (std::int64_t k = std::max(CellAtOrAbove(low.z()) - 1, first_z_); k < end_z; ++k)
      visit(i, k, ColumnAt(i, k));
  }
}

template <class Visitor>
void SolidColumns::ForEachIn(const Eigen::Vector2d& min_xz, const Eigen::Vector2d& max_xz,
                             Visitor&& visit) const {
  const std::int64_t begin_x = std::max(CellAtOrAbove(min_xz.x()), first_x_);
  const std::int64_t begin_z = std::max(CellAtOrAbove(min_xz.y()), first_z_);
  const std::int64_t end_x = std::min(CellAtOrAbove(max_xz.x()), first_x_ + size_x_);
  const std::int64_t end_z = std::min(CellAtOrAbove(max_xz.y()), first_z_ + size_z_);
  for (std::int64_t i = begin_x; i < end_x; ++i) {
    for (std::int64_t k = begin_z; k < end_z; ++k) {
      const std::size_t column = ColumnAt(i, k);
      const std::span<const SolidInterval> intervals(intervals_.data() + first_of_[column],
                                                     first_of_[column + 1] - first_of_[column]);
      if (!intervals.empty())
        visit(static_cast<double>(i) * cell_, static_cast<double>(k) * cell_, intervals);
    }
  }
}

}  // namespace doorforge::internal
