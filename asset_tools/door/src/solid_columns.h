// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
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
  SolidColumns(const TriangleMesh& mesh, const RigidTransform& frame_from_mesh, double cell_m);

  double cell_m() const { return cell_; }

  /// Calls visit(x, z, intervals) for every column with material in the rectangle, x by x.
  template <class Visitor>
  void ForEachIn(const Eigen::Vector2d& min_xz, const Eigen::Vector2d& max_xz,
                 Visitor&& visit) const;

 private:
  int CellAtOrAbove(double coordinate) const;

  /// Calls visit(i, k, column) for the grid cells around a box.
  template <class Visitor>
  void ForEachCellOf(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                     Visitor&& visit) const;

  double cell_;
  int first_x_ = 0;
  int first_z_ = 0;
  int size_x_ = 0;
  int size_z_ = 0;
  std::vector<std::vector<SolidInterval>> columns_;  // x by x
};

inline int SolidColumns::CellAtOrAbove(double coordinate) const {
  return static_cast<int>(std::ceil(coordinate / cell_));
}

template <class Visitor>
void SolidColumns::ForEachCellOf(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                                 Visitor&& visit) const {
  const int end_x = std::min(CellAtOrAbove(high.x()), first_x_ + size_x_);
  const int end_z = std::min(CellAtOrAbove(high.z()), first_z_ + size_z_);
  for (int i = std::max(CellAtOrAbove(low.x()) - 1, first_x_); i < end_x; ++i) {
    for (int k = std::max(CellAtOrAbove(low.z()) - 1, first_z_); k < end_z; ++k)
      visit(i, k, static_cast<std::size_t>((i - first_x_) * size_z_ + (k - first_z_)));
  }
}

template <class Visitor>
void SolidColumns::ForEachIn(const Eigen::Vector2d& min_xz, const Eigen::Vector2d& max_xz,
                             Visitor&& visit) const {
  const int begin_x = std::max(CellAtOrAbove(min_xz.x()), first_x_);
  const int begin_z = std::max(CellAtOrAbove(min_xz.y()), first_z_);
  const int end_x = std::min(CellAtOrAbove(max_xz.x()), first_x_ + size_x_);
  const int end_z = std::min(CellAtOrAbove(max_xz.y()), first_z_ + size_z_);
  for (int i = begin_x; i < end_x; ++i) {
    for (int k = begin_z; k < end_z; ++k) {
      const auto& column =
          columns_[static_cast<std::size_t>((i - first_x_) * size_z_ + (k - first_z_))];
      if (!column.empty()) visit(i * cell_, k * cell_, column);
    }
  }
}

}  // namespace doorforge::internal
