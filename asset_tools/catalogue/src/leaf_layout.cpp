// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "leaf_layout.h"

#include <cmath>
#include <numbers>

#include "family.h"

namespace doorforge::internal {
namespace {

constexpr double kKnuckleRadiusM = 0.006;
constexpr double kHingeInFrontM = 0.0075;

}  // namespace

std::vector<Rectangle> FieldsOf(const FieldGrid& grid, const Rectangle& leaf,
                                const std::string& path) {
  RequireRange(path, "columns", grid.columns, 1, 6);
  RequireRange(path, "rows (count)", static_cast<double>(grid.rows.size()), 1, 8);
  double weights = 0;
  for (const double row : grid.rows) {
    RequireRange(path, "rows", row, 0.05, 20);
    weights += row;
  }
  const double rows = static_cast<double>(grid.rows.size());
  const Eigen::Vector2d size = leaf.max_m - leaf.min_m;
  const double free_width =
      size.x() - 2 * grid.stile_width_m - (grid.columns - 1) * grid.bar_width_m;
  const double free_height =
      size.y() - grid.bottom_rail_m - grid.top_rail_m - (rows - 1) * grid.bar_width_m;
  const double width = free_width / grid.columns;
  RequireRange(path, "width of a field [m]", width, 0.04, 2);
  std::vector<Rectangle> fields;
  double z = leaf.min_m.y() + grid.bottom_rail_m;
  for (const double row : grid.rows) {
    const double height = free_height * row / weights;
    RequireRange(path, "height of a field [m]", height, 0.04, 2);
    for (int column = 0; column < grid.columns; ++column) {
      const double y = leaf.min_m.x() + grid.stile_width_m + column * (width + grid.bar_width_m);
      fields.push_back({{y, z}, {y + width, z + height}});
    }
    z += height + grid.bar_width_m;
  }
  return fields;
}

std::vector<ReliefField> PlankGrooves(const Rectangle& leaf, int planks, ReliefSide side) {
  constexpr double kHalfWidthM = 0.004;
  constexpr double kDepthM = 0.004;
  const double width = (leaf.max_m.x() - leaf.min_m.x()) / planks;
  std::vector<ReliefField> grooves;
  for (int i = 1; i < planks; ++i) {
    const double y = leaf.min_m.x() + i * width;
    // beyond the leaf's ends, so that the groove runs out there
    const Rectangle area{{y - kHalfWidthM, leaf.min_m.y() - 0.02},
                         {y + kHalfWidthM, leaf.max_m.y() + 0.02}};
    grooves.push_back({area, {{0, 0}, {kHalfWidthM, -kDepthM}}, side});
  }
  return grooves;
}

PartJoint BodyHinge(double leaf_edge_x_m) {
  return {{leaf_edge_x_m + kHingeInFrontM, 0, 0}, -Eigen::Vector3d::UnitZ(), 0, 1.50796447};
}

Solid HingeKnuckles(const PartJoint& hinge, const std::vector<double>& heights_m) {
  constexpr double kHalfLengthM = 0.04;
  constexpr int kSides = 12;
  std::vector<Solid> knuckles;
  for (const double height : heights_m) {
    const auto ring = [&](double z, double radius) {
      Ring points;
      for (int k = 0; k < kSides; ++k) {
        const double angle = 2 * std::numbers::pi * (k + 0.5) / kSides;
        points.emplace_back(hinge.origin_m.x() + radius * std::cos(angle),
                            hinge.origin_m.y() + radius * std::sin(angle), z);
      }
      return points;
    };
    const double r = kKnuckleRadiusM;
    knuckles.push_back(
        LoftSolid({ring(height - kHalfLengthM - 0.003, r * 0.6), ring(height - kHalfLengthM, r),
                   ring(height + kHalfLengthM, r), ring(height + kHalfLengthM + 0.003, r * 0.6)},
                  0.001));
  }
  return Joined(knuckles);
}

}  // namespace doorforge::internal
