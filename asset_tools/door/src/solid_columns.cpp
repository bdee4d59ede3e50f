// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "solid_columns.h"

#include <array>
#include <optional>

#include "placed_mesh.h"

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

// depth of the solid along y: overlapping pieces count once
std::vector<SolidInterval> IntervalsOf(std::vector<Crossing>& crossings) {
  std::stable_sort(crossings.begin(), crossings.end(),
                   [](const Crossing& a, const Crossing& b) { return a.y < b.y; });
  std::vector<SolidInterval> intervals;
  int depth = 0;
  double entered = 0;
  for (const Crossing& crossing : crossings) {
    if (depth == 0) entered = crossing.y;
    depth += crossing.step;
    if (depth == 0 && crossing.y > entered) intervals.push_back({entered, crossing.y});
  }
  return intervals;
}

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
  const TriangleMesh placed = Placed(mesh, frame_from_mesh);
  const Eigen::AlignedBox3d bounds = BoundsOf(placed);
  if (bounds.isEmpty()) return;
  first_x_ = CellAtOrAbove(bounds.min().x());
  first_z_ = CellAtOrAbove(bounds.min().z());
  size_x_ = std::max(0, CellAtOrAbove(bounds.max().x()) - first_x_);
  size_z_ = std::max(0, CellAtOrAbove(bounds.max().z()) - first_z_);
  // Columns stand a hair beside the grid, so that they miss vertices and edges of tidy models.
  const double aside = 1e-7 + cell_ * 1e-5;
  std::vector<std::vector<Crossing>> crossings(static_cast<std::size_t>(size_x_ * size_z_));
  for (const Eigen::Vector3i& triangle : placed.triangles) {
    const Corners c = {placed.vertices[static_cast<std::size_t>(triangle[0])],
                       placed.vertices[static_cast<std::size_t>(triangle[1])],
                       placed.vertices[static_cast<std::size_t>(triangle[2])]};
    ForEachCellOf(c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2]),
                  [&](int i, int k, std::size_t column) {
                    const auto crossing = CrossingOf(c, i * cell_ + aside, k * cell_ + 0.7 * aside);
                    if (crossing) crossings[column].push_back(*crossing);
                  });
  }
  columns_.reserve(crossings.size());
  for (std::vector<Crossing>& column : crossings) columns_.push_back(IntervalsOf(column));
}

}  // namespace doorforge::internal
