// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "measure/measured_distances.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace doorforge {

MeasuredDistances::MeasuredDistances(const DistanceGrid& solid, const TriangleTree& surface)
    : solid_(&solid), surface_(&surface) {}

double MeasuredDistances::AtCell(int i, int j, int k) {
  float& distance_m = distance_m_[solid_->grid().IndexOf(i, j, k)];
  if (distance_m < 0) {
    // the solid begins no farther than the grid says, but for two half cells
    const double most_m = solid_->DistanceAt(i, j, k) + std::sqrt(3.0) * solid_->grid().cell_m;
    distance_m = static_cast<float>(surface_->Distance(solid_->grid().CenterOf(i, j, k), most_m));
  }
  return distance_m;
}

double MeasuredDistances::At(const Eigen::Vector3d& point) {
  if (distance_m_.empty()) distance_m_.assign(solid_->grid().count(), -1.0F);
  const Grid& grid = solid_->grid();
  Eigen::Vector3i low, high;
  Eigen::Vector3d share;
  for (int axis = 0; axis < 3; ++axis) {
    const double last = grid.size[axis] - 1;
    const double place =
        std::clamp((point[axis] - grid.origin_m[axis]) / grid.cell_m - 0.5, 0.0, last);
    low[axis] = static_cast<int>(place);
    high[axis] = std::min(low[axis] + 1, grid.size[axis] - 1);
    share[axis] = place - low[axis];
  }
  const auto along_x = [&](int j, int k) {
    return (1 - share.x()) * AtCell(low.x(), j, k) + share.x() * AtCell(high.x(), j, k);
  };
  const auto along_y = [&](int k) {
    return (1 - share.y()) * along_x(low.y(), k) + share.y() * along_x(high.y(), k);
  };
  return (1 - share.z()) * along_y(low.z()) + share.z() * along_y(high.z());
}

}  // namespace doorforge
