// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "solid_columns.h"

#include <array>
#include <optional>
#include <string>

#include "doorforge/core/error.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/mesh/work_budget.h"

namespace doorforge::internal {
namespace {

struct Crossing {
  double y;
  int step;  // +1 where a walk along y enters the solid, -1 where it leaves
};

using Corners = std::array<Eigen::Vector3d, 3>;

double Cross(const Corners& c, std::size_t a, std::size_t b, double x, double z) {
  return (c[a].x() - x) * (c[b].z() - z) - (c[a].z() - z) * (c[b].x() - x);
}

// Appends the depth of the solid along y: overlapping pieces count once. The crossings are sorted.
void AppendIntervals(std::span<Crossing> crossings, std::vector<SolidInterval>& intervals) {
  std::stable_sort(crossings.begin(), crossings.end(),
                   [](const Crossing& a, const Crossing& b) { return a.y < b.y; });
  int depth = 0;
  double entered = 0;
  for (const Crossing& crossing : crossings) {
    if (depth == 0) entered = crossing.y;
    depth += crossing.step;
    if (depth == 0 && crossing.y > entered) intervals.push_back({entered, crossing.y});
  }
}

// The crossings of every column, in the order in which they were found.
class ColumnCrossings {
 public:
  explicit ColumnCrossings(std::size_t columns) : end_of_(columns + 1, 0) {}

  void Add(std::size_t column, const Crossing& crossing) {
    if (found_.size() >= static_cast<std::size_t>(SolidColumns::kMaxCrossings))
      throw Error(ErrorCode::kFormat, "a mesh crosses its columns more than " +
                                          std::to_string(SolidColumns::kMaxCrossings) +
                                          " times, which is as often as is allowed; simplify it");
    found_.push_back({column, crossing});
    ++end_of_[column + 1];
  }

  /// Calls visit(crossings) for each column in turn.
  template <class Visitor>
  void ForEachColumn(Visitor&& visit) {
    for (std::size_t c = 1; c < end_of_.size(); ++c) end_of_[c] += end_of_[c - 1];
    std::vector<Crossing> sorted(found_.size());
    std::vector<std::uint32_t> next(end_of_.begin(), end_of_.end() - 1);
    for (const Found& found : found_) sorted[next[found.column]++] = found.crossing;
    for (std::size_t c = 0; c + 1 < end_of_.size(); ++c)
      visit(std::span<Crossing>(sorted.data() + end_of_[c], end_of_[c + 1] - end_of_[c]));
  }

 private:
  struct Found {
    std::size_t column;
    Crossing crossing;
  };

  std::vector<Found> found_;
  std::vector<std::uint32_t> end_of_;  // of the column before; while they are found, their number
};

// where the triangle meets the column at (x, z), if it does
std::optional<Crossing> CrossingOf(const Corners& c, double x, double z) {
  const double weight_0 = Cross(c, 1, 2, x, z);
  const double weight_1 = Cross(c, 2, 0, x, z);
  const double weight_2 = Cross(c, 0, 1, x, z);
  const bool positive = weight_0 > 0 && weight_1 > 0 && weight_2 > 0;
  const bool negative = weight_0 < 0 && weight_1 < 0 && weight_2 < 0;
  if (!positive && !negative) return std::nullopt;
  const double y = (weight_0 * c[0].y() + weight_1 * c[1].y() + weight_2 * c[2].y()) /
                   (weight_0 + weight_1 + weight_2);
  // seen with x to the right and z up, y points away: a positive turn faces the start
  return Crossing{y, positive ? 1 : -1};
}

}  // namespace

SolidColumns::SolidColumns(const TriangleMesh& mesh, const RigidTransform& frame_from_mesh,
                           double cell_m)
    : cell_(cell_m) {
  const TriangleMesh placed = Transformed(mesh, frame_from_mesh);
  const Eigen::AlignedBox3d bounds = BoundsOf(placed);
  if (bounds.isEmpty()) return;
  LayOut(bounds);
  // Columns stand a hair beside the grid, so that they miss vertices and edges of tidy models.
  const double aside = 1e-7 + cell_ * 1e-5;
  ColumnCrossings crossings(static_cast<std::size_t>(size_x_ * size_z_));
  for (const Eigen::Vector3i& triangle : placed.triangles) {
    const Corners c = {placed.vertices[static_cast<std::size_t>(triangle[0])],
                       placed.vertices[static_cast<std::size_t>(triangle[1])],
                       placed.vertices[static_cast<std::size_t>(triangle[2])]};
    unsigned visited = 0;
    ForEachCellOf(c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2]),
                  [&](std::int64_t i, std::int64_t k, std::size_t column) {
                    ++visited;
                    const auto crossing = CrossingOf(c, static_cast<double>(i) * cell_ + aside,
                                                     static_cast<double>(k) * cell_ + 0.7 * aside);
                    if (crossing) crossings.Add(column, *crossing);
                  });
    CheckWork(visited);
  }
  first_of_.reserve(static_cast<std::size_t>(size_x_ * size_z_) + 1);
  crossings.ForEachColumn([&](std::span<Crossing> column) {
    first_of_.push_back(static_cast<std::uint32_t>(intervals_.size()));
    AppendIntervals(column, intervals_);
  });
  first_of_.push_back(static_cast<std::uint32_t>(intervals_.size()));
}

void SolidColumns::LayOut(const Eigen::AlignedBox3d& bounds) {
  const std::int64_t first_x = CellAtOrAbove(bounds.min().x());
  const std::int64_t first_z = CellAtOrAbove(bounds.min().z());
  const std::int64_t size_x = std::max<std::int64_t>(0, CellAtOrAbove(bounds.max().x()) - first_x);
  const std::int64_t size_z = std::max<std::int64_t>(0, CellAtOrAbove(bounds.max().z()) - first_z);
  // each by itself first, since their product need not fit
  if (size_x > kMaxColumns || size_z > kMaxColumns || size_x * size_z > kMaxColumns) {
    const Eigen::Vector3d size = bounds.sizes();
    throw Error(ErrorCode::kFormat,
                "a mesh of " + std::to_string(size.x()) + " by " + std::to_string(size.z()) +
                    " m takes more columns of " + std::to_string(std::lround(1000 * cell_)) +
                    " mm than the " + std::to_string(kMaxColumns) +
                    " allowed; does a vertex lie far off, or is it in millimetres?");
  }
  first_x_ = first_x;
  first_z_ = first_z;
  size_x_ = size_x;
  size_z_ = size_z;
}

}  // namespace doorforge::internal
