// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "measure/measured_distances.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace doorforge {
namespace {

constexpr double kFloatRounding = 1e-6;                // more than that of float
constexpr std::uint64_t kStepsOfTriangle = 20;         // of a distance to one
constexpr std::uint64_t kStepsOfSearch = 150;          // of one to the nearest
constexpr double kHalfDiagonal = 0.8661 * (1 + 1e-4);  // cells; more than that of a cell

// Each value becomes the largest of its own and of its neighbours' along an axis.
class SpreadLargest {
 public:
  explicit SpreadLargest(std::size_t count) : before_(count) {}

  // `lines` values that lie side by side, `stride` before the next of each line.
  void Along(float* first, std::size_t lines, std::size_t stride, int count) {
    std::copy_n(first, lines, before_.begin());
    for (int i = 0; i < count; ++i, first += stride) {
      const float* const next = i + 1 < count ? first + stride : first;
      for (std::size_t n = 0; n < lines; ++n) {
        const float own = first[n];
        first[n] = std::max(std::max(before_[n], own), next[n]);
        before_[n] = own;
      }
    }
  }

 private:
  std::vector<float> before_;
};

}  // namespace

MeasuredDistances::MeasuredDistances(const DistanceGrid& solid, const TriangleTree& surface)
    : solid_(&solid), surface_(&surface) {}

double MeasuredDistances::MostBeyondGrid() const { return std::sqrt(3.0) * solid_->grid().cell_m; }

// A point of the solid's surface lies in the nearest cell that the grid marks, or on the way to its
// centre, if that is inside.
double MeasuredDistances::MostAtCell(double grid_m) const {
  const double cell_m = solid_->grid().cell_m;
  return grid_m > 0 ? grid_m + kHalfDiagonal * cell_m : MostBeyondGrid();
}

// Between centres At() is no more than at the most distant of those around.
const MarkedCells& MeasuredDistances::FarCells(double above_m) {
  if (far_ && far_above_m_ == above_m) return *far_;
  const Eigen::Vector3i size = solid_->grid().size;
  const auto nx = static_cast<std::size_t>(size.x());
  const auto ny = static_cast<std::size_t>(size.y());
  std::vector<float> around_m = solid_->distances();
  SpreadLargest spread(nx * ny);
  spread.Along(around_m.data(), nx * ny, nx * ny, size.z());
  for (int k = 0; k < size.z(); ++k) {
    float* const layer = around_m.data() + static_cast<std::size_t>(k) * nx * ny;
    spread.Along(layer, nx, nx, size.y());
    for (std::size_t j = 0; j < ny; ++j) spread.Along(layer + j * nx, 1, 1, size.x());
  }
  far_.emplace(size, [&](std::size_t index) {
    return solid_->distances()[index] > 0 &&
           std::max(MostBeyondGrid(), MostAtCell(around_m[index])) > above_m;
  });
  far_above_m_ = above_m;
  return *far_;
}

// Neighbours that were asked for tell as much: distances change by no more than the way.
double MeasuredDistances::MostBeside(int i, int j, int k) const {
  const Eigen::Vector3i at(i, j, k);
  float least_m = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    for (const int step : {-1, 1}) {
      Eigen::Vector3i beside = at;
      beside[axis] += step;
      if (beside[axis] < 0 || beside[axis] >= solid_->grid().size[axis]) continue;
      const float known_m = distance_m_[solid_->grid().IndexOf(beside.x(), beside.y(), beside.z())];
      if (known_m >= 0) least_m = std::min(least_m, known_m);
    }
  }
  return (1 + kFloatRounding) * (least_m + solid_->grid().cell_m);
}

double MeasuredDistances::AtCell(int i, int j, int k) {
  const std::size_t index = solid_->grid().IndexOf(i, j, k);
  float& distance_m = distance_m_[index];
  if (distance_m < 0) {
    steps_ += kStepsOfSearch;
    const double most_m = MostAtCell(solid_->DistanceAt(i, j, k));
    const TriangleTree::Near near = surface_->NearestTriangle(
        solid_->grid().CenterOf(i, j, k), std::min(most_m, MostBeside(i, j, k)));
    distance_m = static_cast<float>(near.distance_m);
    nearest_[index] = near.triangle;
  }
  return distance_m;
}

void MeasuredDistances::BeReady() {
  if (!distance_m_.empty()) return;
  distance_m_.assign(solid_->grid().count(), -1.0F);
  nearest_.assign(solid_->grid().count(), -1);
}

bool MeasuredDistances::NoneBeyond(const std::array<Eigen::Vector3d, 3>& corners, double far_m) {
  BeReady();
  steps_ += kStepsOfTriangle;
  const Eigen::Vector3i cell = solid_->grid().CellAt((corners[0] + corners[1] + corners[2]) / 3);
  AtCell(cell.x(), cell.y(), cell.z());
  const int nearest = nearest_[solid_->grid().IndexOf(cell.x(), cell.y(), cell.z())];
  return nearest >= 0 &&
         std::all_of(corners.begin(), corners.end(), [&](const Eigen::Vector3d& corner) {
           return surface_->DistanceTo(nearest, corner) <= far_m;
         });
}

double MeasuredDistances::At(const Eigen::Vector3d& point) {
  BeReady();
  steps_ += kStepsOfTriangle;
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
