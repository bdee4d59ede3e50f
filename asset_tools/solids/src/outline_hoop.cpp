// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/solids/outline_hoop.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "doorforge/core/config_io.h"

namespace doorforge::internal {
namespace {

constexpr double kJointM = 0.0002;  // between solids that touch
constexpr int kHalfArcSteps = 5;

// Points of a head from its right to its left springing, both included, in the unit of half the
// width and of the rise: (1, 0) over (0, 1) to (-1, 0).
Polygon UnitHead(HeadKind shape, double rise_in_halves) {
  Polygon head;
  for (int i = -kHalfArcSteps; i <= kHalfArcSteps; ++i) {
    const double t = -static_cast<double>(i) / kHalfArcSteps;
    if (shape == HeadKind::kRound) {
      head.emplace_back(std::sin(std::numbers::pi / 2 * t), std::cos(std::numbers::pi / 2 * t));
    } else if (shape == HeadKind::kSegment) {
      // on the circle through both springings and the crown
      const double r = (1 + rise_in_halves * rise_in_halves) / (2 * rise_in_halves);
      const double reach = std::atan2(1, r - rise_in_halves);
      head.emplace_back(r * std::sin(reach * t),
                        (r * std::cos(reach * t) - (r - rise_in_halves)) / rise_in_halves);
    } else {
      // pointed: each half bulges over a straight roof
      const double along = 1 - std::abs(t);
      head.emplace_back(t, along + 0.42 * along * (1 - along));
    }
  }
  return head;
}

void AppendBar(const Polygon& bar, const PrismSpan& depth, std::vector<Solid>& solids) {
  Polygon clean;
  for (const Eigen::Vector2d& p : bar) {
    if (clean.empty() || (p - clean.back()).norm() > 0.0015) clean.push_back(p);
  }
  while (clean.size() > 3 && (clean.front() - clean.back()).norm() < 0.0015) clean.pop_back();
  if (clean.size() >= 3) solids.push_back(ConvexPrism(clean, PrismAxis::kX, depth, 0.001));
}

// A bar of a width from one point to another, cut off at the outline.
Polygon CutBar(const Polygon& outline, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
               double width_m) {
  const Eigen::Vector2d along = (to - from).normalized();
  const Eigen::Vector2d side = Eigen::Vector2d(-along.y(), along.x()) * width_m / 2;
  Polygon bar = {from - side, to - side, to + side, from + side};
  for (std::size_t i = 0; i < outline.size() && !bar.empty(); ++i) {
    const Eigen::Vector2d edge = outline[(i + 1) % outline.size()] - outline[i];
    bar = Clipped(bar, outline[i], Eigen::Vector2d(edge.y(), -edge.x()).normalized());
  }
  return bar;
}

struct Bounds {
  Eigen::Vector2d min_m;
  Eigen::Vector2d max_m;
};

Bounds BoundsOfPolygon(const Polygon& polygon) {
  Bounds bounds{polygon.front(), polygon.front()};
  for (const Eigen::Vector2d& p : polygon) {
    bounds.min_m = bounds.min_m.cwiseMin(p);
    bounds.max_m = bounds.max_m.cwiseMax(p);
  }
  return bounds;
}

}  // namespace

Polygon OutlineWithHead(const Rectangle& box, const HeadShape& head, const std::string& path) {
  const Eigen::Vector2d& low = box.min_m;
  const Eigen::Vector2d& high = box.max_m;
  if (head.shape == HeadKind::kFlat) return BoxPolygon(low, high);
  RequireRange(path, "rise_m", head.rise_m, 0.03, 0.6 * (high.y() - low.y()));
  const double spring = high.y() - head.rise_m;
  if (head.shape == HeadKind::kSlantLeft)
    return {low, {high.x(), low.y()}, high, {low.x(), spring}};
  if (head.shape == HeadKind::kSlantRight)
    return {low, {high.x(), low.y()}, {high.x(), spring}, {low.x(), high.y()}};
  const double half = (high.x() - low.x()) / 2;
  if (head.shape == HeadKind::kSegment) RequireRange(path, "rise_m", head.rise_m, 0.03, 0.9 * half);
  Polygon outline = {low, {high.x(), low.y()}};
  for (const Eigen::Vector2d& p : UnitHead(head.shape, head.rise_m / half))
    outline.emplace_back(low.x() + half * (1 + p.x()), spring + head.rise_m * p.y());
  return outline;
}

Solid OutlineHoop(const Polygon& outline, const Polygon& section,
                  const std::vector<HoopBox>& boxes) {
  const std::size_t n = outline.size();
  const auto rings_of = [&](const Polygon& profile) {
    std::vector<Ring> rings(n);
    for (const Eigen::Vector2d& p : profile) {
      const Polygon moved = Inset(outline, -p.x());
      // clockwise, as a section that is counter-clockwise in (u, x) asks
      for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Vector2d& at = moved[n - 1 - i];
        rings[i].emplace_back(p.y(), at.x(), at.y());
      }
    }
    return rings;
  };
  Solid hoop{LoftLoop(rings_of(section)), {}};
  for (const HoopBox& box : boxes) {
    std::vector<Ring> rings = rings_of(BoxPolygon(box.section.min_m, box.section.max_m));
    // from a corner of the foot, so that no hull runs around one
    std::rotate(rings.begin(), rings.begin() + static_cast<std::ptrdiff_t>(n - 2), rings.end());
    rings.push_back(rings.front());
    const std::vector<TriangleMesh> hulls = LoftHulls(rings, box.tolerance_m);
    hoop.hulls.insert(hoop.hulls.end(), hulls.begin(), hulls.end());
  }
  return hoop;
}

Solid BarsInside(const Polygon& outline, const BarGrid& grid, const PrismSpan& depth) {
  const Polygon inside = Inset(outline, kJointM);
  const auto [low, high] = BoundsOfPolygon(inside);
  std::vector<Solid> solids;
  const double pane = (high.x() - low.x() - (grid.columns - 1) * grid.width_m) / grid.columns;
  for (int i = 1; i < grid.columns; ++i) {
    const double y = low.x() + i * (pane + grid.width_m) - grid.width_m;
    AppendBar(ClippedToBand(inside, 0, y, y + grid.width_m), depth, solids);
  }
  const double height = (high.y() - low.y() - (grid.rows - 1) * grid.width_m) / grid.rows;
  for (int j = 1; j < grid.rows; ++j) {
    const double z = low.y() + j * (height + grid.width_m) - grid.width_m;
    const Polygon row = ClippedToBand(inside, 1, z, z + grid.width_m);
    for (int i = 0; i < grid.columns && !row.empty(); ++i) {
      const double y = low.x() + i * (pane + grid.width_m);
      AppendBar(ClippedToBand(row, 0, y + kJointM, y + pane - kJointM), depth, solids);
    }
  }
  return Joined(solids);
}

Solid RaysInside(const Polygon& outline, int rays, double hub_m, const BarGrid& grid,
                 const PrismSpan& depth) {
  const Polygon inside = Inset(outline, kJointM);
  const auto [low, high] = BoundsOfPolygon(inside);
  const Eigen::Vector2d center((low.x() + high.x()) / 2, low.y());
  const double reach = (high - low).norm();
  std::vector<Solid> solids;
  const auto way = [&](double angle) { return Eigen::Vector2d(std::cos(angle), std::sin(angle)); };
  for (int i = 0; i < rays; ++i) {
    const double angle = std::numbers::pi * (i + 1) / (rays + 1);
    const Eigen::Vector2d from = center + way(angle) * (hub_m + grid.width_m / 2 + 0.003);
    AppendBar(CutBar(inside, from, center + way(angle) * reach, grid.width_m), depth, solids);
  }
  // the hub: pieces of a ring
  const int pieces = rays + 1;
  for (int i = 0; i < pieces; ++i) {
    const double a = std::numbers::pi * i / pieces;
    const double b = std::numbers::pi * (i + 1) / pieces;
    const double inner = hub_m - grid.width_m / 2;
    const double outer = hub_m + grid.width_m / 2;
    Polygon piece = {center + inner * way(a), center + outer * way(a), center + outer * way(b),
                     center + inner * way(b)};
    if (i == 0) {
      piece[0].y() += kJointM;
      piece[1].y() += kJointM;
    }
    if (i == pieces - 1) {
      piece[2].y() += kJointM;
      piece[3].y() += kJointM;
    }
    AppendBar(Inset(piece, kJointM / 2), depth, solids);
  }
  return Joined(solids);
}

}  // namespace doorforge::internal
