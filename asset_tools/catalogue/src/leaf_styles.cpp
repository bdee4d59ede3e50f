// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "leaf_styles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace doorforge::internal {
namespace {

constexpr double kLeafStyleHullToleranceM = 0.006;
constexpr double kLeafStyleJointM = 0.0001;  // between solids that touch

Rectangle InnerOf(const LeafShape& leaf, double by) {
  return {leaf.outline.min_m.array() + by, leaf.outline.max_m.array() - by};
}

ReliefSlab SlabOf(const LeafShape& leaf) {
  ReliefSlab slab;
  slab.outline = leaf.outline;
  slab.thickness_m = leaf.thickness_m;
  slab.edge_radius_m = leaf.edge_radius_m;
  return slab;
}

// A bar in the plane of the leaf between two points, cut off at a rectangle; depth along x.
Solid CutBar(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width_m,
             const Rectangle& window, const PrismSpan& depth) {
  const Eigen::Vector2d along = (to - from).normalized();
  const Eigen::Vector2d side = Eigen::Vector2d(-along.y(), along.x()) * width_m / 2;
  const Eigen::Vector2d more = along * width_m;
  Polygon bar = {from - more - side, to + more - side, to + more + side, from - more + side};
  for (const int axis : {0, 1})
    bar = ClippedToBand(bar, axis, window.min_m[axis] + kLeafStyleJointM,
                        window.max_m[axis] - kLeafStyleJointM);
  if (bar.size() < 3) return {};
  return ConvexPrism(bar, PrismAxis::kX, depth, 0);
}

}  // namespace

Solid LouvredLeaf(const LeafShape& leaf, int slats) {
  ReliefSlab frame = SlabOf(leaf);
  const Rectangle window = InnerOf(leaf, leaf.border_m);
  frame.openings = {window};
  std::vector<Solid> solids = {ReliefSolid(frame, kLeafStyleHullToleranceM)};
  const double pitch = (window.max_m.y() - window.min_m.y()) / slats;
  const double tilt = 35 * std::numbers::pi / 180;
  const double half_thickness = 0.004;
  // as wide as frame and neighbours leave room for
  const double half_width = std::min(0.45 * leaf.thickness_m / std::cos(tilt) - half_thickness,
                                     0.45 * pitch / std::sin(tilt) - half_thickness);
  const double half_length = (window.max_m.x() - window.min_m.x()) / 2 - 0.0015;
  const Solid slat = ChamferedBox({-half_width, -half_length, -half_thickness},
                                  {half_width, half_length, half_thickness}, 0.0015);
  for (int i = 0; i < slats; ++i) {
    const Eigen::Vector3d at(-leaf.thickness_m / 2, (window.min_m.x() + window.max_m.x()) / 2,
                             window.min_m.y() + pitch * (i + 0.5));
    solids.push_back(
        Transformed(slat, Translation(at) * RotationAbout(Eigen::Vector3d::UnitY(), tilt)));
  }
  return Joined(solids);
}

Solid BracedLeaf(const LeafShape& leaf, int panels, bool crossed) {
  constexpr double kBoardM = 0.009;
  ReliefSlab back = SlabOf(leaf);
  back.thickness_m = leaf.thickness_m - kBoardM;
  std::vector<Solid> solids = {
      Moved(ReliefSolid(back, kLeafStyleHullToleranceM), {-kBoardM, 0, 0})};
  // the boards in front, as a frame with windows
  ReliefSlab frame = SlabOf(leaf);
  frame.thickness_m = kBoardM - kLeafStyleJointM;
  const Rectangle inner = InnerOf(leaf, leaf.border_m);
  const double rail = 0.7 * leaf.border_m;
  const double height = (inner.max_m.y() - inner.min_m.y() - rail * (panels - 1)) / panels;
  for (int i = 0; i < panels; ++i) {
    const double z = inner.min_m.y() + i * (height + rail);
    frame.openings.push_back({{inner.min_m.x(), z}, {inner.max_m.x(), z + height}});
  }
  solids.push_back(ReliefSolid(frame, kLeafStyleHullToleranceM));
  const PrismSpan depth{kLeafStyleJointM - kBoardM, -0.001};
  for (const Rectangle& window : frame.openings) {
    const Eigen::Vector2d a = window.min_m;
    const Eigen::Vector2d b = window.max_m;
    const Eigen::Vector2d middle = (a + b) / 2;
    const double width = 0.7 * leaf.border_m;
    solids.push_back(CutBar(a, b, width, window, depth));
    if (!crossed) continue;
    const Eigen::Vector2d c(a.x(), b.y());
    const Eigen::Vector2d d(b.x(), a.y());
    // the second diagonal stops where its corners meet the first
    const Eigen::Vector2d u = (b - a).normalized();
    const Eigen::Vector2d v = (d - c).normalized();
    const double sine = std::abs(u.x() * v.y() - u.y() * v.x());
    const double stop = width / 2 * (1 + std::abs(u.dot(v))) / sine + width + kLeafStyleJointM;
    solids.push_back(CutBar(c, middle - v * stop, width, window, depth));
    solids.push_back(CutBar(middle + v * stop, d, width, window, depth));
  }
  return Joined(solids);
}

Solid LatticedLeaf(const LeafShape& leaf, int bars, double bar_width_m) {
  ReliefSlab frame = SlabOf(leaf);
  const Rectangle window = InnerOf(leaf, leaf.border_m);
  frame.openings = {window};
  std::vector<Solid> solids = {ReliefSolid(frame, kLeafStyleHullToleranceM)};
  const Eigen::Vector2d size = window.max_m - window.min_m;
  const Eigen::Vector2d middle = (window.max_m + window.min_m) / 2;
  const double reach = size.x() + size.y();
  const double bar_x = -leaf.thickness_m / 2;
  for (const int way : {1, -1}) {
    const Eigen::Vector2d along = Eigen::Vector2d(1, way).normalized();
    const Eigen::Vector2d across(-along.y(), along.x());
    const double pitch = reach / std::numbers::sqrt2 / bars;
    const PrismSpan depth = way > 0 ? PrismSpan{bar_x + kLeafStyleJointM, bar_x + 0.006}
                                    : PrismSpan{bar_x - 0.006, bar_x - kLeafStyleJointM};
    for (int i = 0; i < bars; ++i) {
      const Eigen::Vector2d on = middle + across * pitch * (i - (bars - 1) / 2.0);
      solids.push_back(CutBar(on - along * reach, on + along * reach, bar_width_m, window, depth));
    }
  }
  return Joined(solids);
}

Solid ArchedLeaf(const LeafShape& leaf, double rise_m, bool open) {
  constexpr int kSteps = 8;
  const Rectangle& out = leaf.outline;
  const Rectangle in = InnerOf(leaf, leaf.border_m);
  const PrismSpan depth{-leaf.thickness_m, 0};
  const double edge = leaf.edge_radius_m;
  std::vector<Solid> solids;
  const auto board = [&](const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    solids.push_back(
        ConvexPrism(BoxPolygon(low.array() + kLeafStyleJointM, high.array() - kLeafStyleJointM),
                    PrismAxis::kX, depth, edge));
  };
  board(out.min_m, {in.min_m.x(), out.max_m.y()});
  board({in.max_m.x(), out.min_m.y()}, out.max_m);
  board({in.min_m.x(), out.min_m.y()}, {in.max_m.x(), in.min_m.y()});
  const auto arch = [&](int i) {
    const double t = static_cast<double>(i) / kSteps;
    return Eigen::Vector2d(in.min_m.x() + t * (in.max_m.x() - in.min_m.x()),
                           in.max_m.y() - rise_m + rise_m * std::sin(std::numbers::pi * t));
  };
  // the upper rail in strips, one hull each; one mesh
  Polygon rail = {{in.min_m.x() + kLeafStyleJointM, out.max_m.y() - kLeafStyleJointM}};
  std::vector<TriangleMesh> strips;
  for (int i = 0; i <= kSteps; ++i) {
    Eigen::Vector2d p = arch(i);
    if (i == 0) p.x() += kLeafStyleJointM;
    if (i == kSteps) p.x() -= kLeafStyleJointM;
    rail.push_back(p);
  }
  rail.emplace_back(in.max_m.x() - kLeafStyleJointM, out.max_m.y() - kLeafStyleJointM);
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector2d a = rail[static_cast<std::size_t>(i) + 1];
    const Eigen::Vector2d b = rail[static_cast<std::size_t>(i) + 2];
    const double top = out.max_m.y() - kLeafStyleJointM;
    const Solid strip = ConvexPrism({a, b, {b.x(), top}, {a.x(), top}}, PrismAxis::kX, depth, 0);
    strips.push_back(strip.hulls.front());
  }
  std::vector<Ring> rings(2);
  for (const Eigen::Vector2d& p : rail) {
    rings[0].emplace_back(depth.low_m, p.x(), p.y());
    rings[1].emplace_back(depth.high_m, p.x(), p.y());
  }
  solids.push_back({LoftProfile(rings, rail), strips});
  if (!open) {
    Polygon panel = {in.max_m - Eigen::Vector2d(0, rise_m), in.min_m};
    panel = {in.min_m, {in.max_m.x(), in.min_m.y()}};
    for (int i = kSteps; i >= 0; --i) panel.push_back(arch(i));
    solids.push_back(ConvexPrism(Inset(panel, kLeafStyleJointM), PrismAxis::kX,
                                 {-0.75 * leaf.thickness_m, -0.3 * leaf.thickness_m}, 0));
  }
  return Joined(solids);
}

Solid BowedLeaf(const LeafShape& leaf, double bow_m) {
  constexpr int kSteps = 16;
  const Rectangle in = InnerOf(leaf, leaf.border_m);
  std::vector<Eigen::Vector2d> middle = {{0, leaf.outline.min_m.x()}};  // (x, y)
  for (int i = 0; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps;
    middle.emplace_back(bow_m * (0.5 - 0.5 * std::cos(2 * std::numbers::pi * t)),
                        in.min_m.x() + t * (in.max_m.x() - in.min_m.x()));
  }
  middle.emplace_back(0, leaf.outline.max_m.x());
  // rings stand upright across the leaf, one at each point of the curve
  const double e = leaf.edge_radius_m;
  const auto ring = [&](const Eigen::Vector2d& p, double inset) {
    const double z0 = leaf.outline.min_m.y() + inset;
    const double z1 = leaf.outline.max_m.y() - inset;
    const double back = p.x() - leaf.thickness_m;
    const double front = p.x() - inset;
    const double c = e;
    const double y = p.y();
    return Ring{{front, y, z0 + c},        {front, y, z1 - c},        {front - c, y, z1},
                {back + inset + c, y, z1}, {back + inset, y, z1 - c}, {back + inset, y, z0 + c},
                {back + inset + c, y, z0}, {front - c, y, z0}};
  };
  std::vector<Ring> rings = {ring(middle.front(), e)};
  rings.push_back(ring(middle.front() + Eigen::Vector2d(0, e), 0));
  for (std::size_t i = 1; i + 1 < middle.size(); ++i) rings.push_back(ring(middle[i], 0));
  rings.push_back(ring(middle.back() - Eigen::Vector2d(0, e), 0));
  rings.push_back(ring(middle.back(), e));
  // seen by someone whom the loft comes towards (from +y) the ring has to run the other way round
  for (Ring& r : rings) std::reverse(r.begin(), r.end());
  return LoftSolid(rings, 0.003);
}

Solid ReededLeaf(const LeafShape& leaf, int reeds) {
  ReliefSlab slab = SlabOf(leaf);
  const Rectangle in = InnerOf(leaf, leaf.border_m);
  const double width = (in.max_m.x() - in.min_m.x()) / reeds;
  const double depth = std::min(0.005, 0.3 * width);
  for (int i = 0; i < reeds; ++i) {
    const double y = in.min_m.x() + i * width;
    const Rectangle area{{y + 0.001, in.min_m.y()}, {y + width - 0.001, in.max_m.y()}};
    const double half = width / 2 - 0.001;
    slab.fields.push_back(
        {area,
         {{0, 0}, {0.25 * half, -0.66 * depth}, {0.6 * half, -0.94 * depth}, {half, -depth}},
         ReliefSide::kFront});
  }
  return ReliefSolid(slab, kLeafStyleHullToleranceM);
}

}  // namespace doorforge::internal
