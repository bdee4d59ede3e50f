// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "car/car_leaf.h"

#include <algorithm>
#include <cmath>

#include "family.h"

namespace doorforge::internal {
namespace {

constexpr double kEdgeRadiusM = 0.008;
constexpr double kCarLeafHullToleranceM = 0.006;
constexpr double kFrameThicknessM = 0.034;  // of the window frame
constexpr double kWidestBelowBeltM = 0.2;   // height of the widest line
constexpr double kCreaseBelowBeltM = 0.27;  // below any handle
constexpr double kCreaseHalfWidthM = 0.03;
constexpr double kCarLeafJointM = 0.0005;  // between solids that touch

double Share(double value, double low, double high) {
  return std::clamp((value - low) / (high - low), 0.0, 1.0);
}

double CreaseAt(const CarLeafShape& leaf, double z) {
  const double from_line = std::abs(z - (leaf.belt_m - kCreaseBelowBeltM));
  return leaf.crease_m * (1 - Share(from_line, 0, kCreaseHalfWidthM));
}

double ThicknessAt(const CarLeafShape& leaf, double z) {
  if (!HasWindowFrame(leaf)) return leaf.thickness_m;
  const double t = Share(z, leaf.belt_m - 0.08, leaf.belt_m);
  return leaf.thickness_m + (kFrameThicknessM - leaf.thickness_m) * t;
}

double TopOf(const CarLeafShape& leaf) { return HasWindowFrame(leaf) ? leaf.roof_m : leaf.belt_m; }

std::vector<Rectangle> WindowsOf(const CarLeafShape& leaf) {
  if (!HasWindowFrame(leaf) || leaf.blind) return {};
  const double low = leaf.belt_m;
  const double high = leaf.roof_m - leaf.frame_width_m;
  // the lean at the front narrows what lies there
  const double front = leaf.frame_width_m * 1.3;
  const double rear = leaf.length_m - leaf.frame_width_m;
  if (leaf.quarter_m <= 0) return {{{front, low}, {rear, high}}};
  const double bar = front + leaf.quarter_m;
  return {{{front, low}, {bar, high}}, {{bar + 0.05, low}, {rear, high}}};
}

std::vector<double> LinesAlongY(const CarLeafShape& leaf, const std::vector<Rectangle>& windows) {
  std::vector<double> borders = {0, leaf.length_m};
  for (const Rectangle& window : windows) {
    borders.push_back(window.min_m.x());
    borders.push_back(window.max_m.x());
  }
  return EdgeLines(EqualLines(0, leaf.length_m, 8), borders, kEdgeRadiusM);
}

std::vector<double> LinesAlongZ(const CarLeafShape& leaf, const std::vector<Rectangle>& windows) {
  std::vector<double> lines = EqualLines(leaf.sill_m, leaf.belt_m - 0.08, 6);
  const double crease = leaf.belt_m - kCreaseBelowBeltM;
  lines.insert(lines.end(),
               {crease - kCreaseHalfWidthM, crease, crease + kCreaseHalfWidthM, leaf.belt_m});
  std::vector<double> borders = {leaf.sill_m, TopOf(leaf)};
  if (HasWindowFrame(leaf)) {
    const double high = leaf.roof_m - leaf.frame_width_m;
    if (!windows.empty()) borders.insert(borders.end(), {leaf.belt_m, high});
    const std::vector<double> upper = EqualLines(leaf.belt_m, high, 4);
    lines.insert(lines.end(), upper.begin(), upper.end());
  }
  std::sort(lines.begin(), lines.end());
  // lines that nearly coincide make slivers
  std::vector<double> kept;
  for (const double line : lines) {
    if (kept.empty() || line - kept.back() > 0.012) kept.push_back(line);
  }
  return EdgeLines(kept, borders, kEdgeRadiusM);
}

// On the outside, `depth` below the skin: `u` as if the ends were upright.
Eigen::Vector3d PointOf(const CarLeafShape& leaf, double u, double z, double depth) {
  const double share = u / leaf.length_m;
  const double begin = FrontEnd(leaf, z);
  const double y = begin + share * (RearEnd(leaf, z) - begin);
  const double bow = leaf.bow_m * std::pow(2 * share - 1, 2);
  return {SkinX(leaf, z) - bow - depth, y, z};
}

// A pad on the inside.
Solid Pad(const CarLeafShape& leaf, const Rectangle& place, double depth_m) {
  constexpr double kRadiusM = 0.006;
  PanelGrid grid;
  grid.u_m = EdgeLines(EqualLines(place.min_m.x(), place.max_m.x(), 2),
                       {place.min_m.x(), place.max_m.x()}, kRadiusM);
  grid.v_m = EdgeLines(EqualLines(place.min_m.y(), place.max_m.y(), 2),
                       {place.min_m.y(), place.max_m.y()}, kRadiusM);
  grid.edge_radius_m = kRadiusM;
  const double inside = leaf.thickness_m + kCarLeafJointM;
  grid.front = [leaf, inside](double u, double z) { return PointOf(leaf, u, z, inside); };
  grid.back = [leaf, inside, depth_m](double u, double z) {
    return PointOf(leaf, u, z, inside + depth_m);
  };
  return PanelSolid(grid, kCarLeafHullToleranceM);
}

// The housing narrows towards the car's front; an arm holds it beside the window's lower corner.
Solid Mirror(const CarLeafShape& leaf) {
  constexpr double kMiddleM = 0.17;  // from the hinge edge
  constexpr double kGapM = 0.03;     // between skin and housing
  const double z = leaf.belt_m - 0.03;
  const double skin = SkinX(leaf, z);
  const double width = leaf.mirror_reach_m - kGapM;
  const Eigen::Vector2d half(width / 2, leaf.mirror_m / 2);
  const std::vector<Eigen::Vector2d> outline = RoundedRectangle(half, 0.45 * half.minCoeff(), 4);
  const Eigen::Vector3d center(skin + kGapM + half.x(), kMiddleM, z - 0.02 + half.y());
  std::vector<Ring> rings;
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(-0.055, 0.62), Eigen::Vector2d(-0.03, 0.88),
                                    Eigen::Vector2d(0.0, 0.98), Eigen::Vector2d(0.035, 1)}) {
    Ring ring;
    for (const Eigen::Vector2d& point : outline)
      ring.emplace_back(center.x() + at.y() * point.x(), center.y() + at.x(),
                        center.z() + at.y() * point.y());
    // counter-clockwise for someone behind the car
    std::reverse(ring.begin(), ring.end());
    rings.push_back(std::move(ring));
  }
  const Solid arm =
      ChamferedBox({skin + kCarLeafJointM, kMiddleM - 0.03, z - 0.014},
                   {skin + kGapM - kCarLeafJointM, kMiddleM + 0.02, z + 0.014}, 0.004);
  return Joined({LoftSolid(rings, kCarLeafHullToleranceM), arm});
}

}  // namespace

bool HasWindowFrame(const CarLeafShape& leaf) { return leaf.roof_m > leaf.belt_m + 0.01; }

void CheckCarLeaf(const CarLeafShape& leaf, const std::string& path) {
  RequireRange(path, "length_m", leaf.length_m, 0.95, 1.32);
  RequireRange(path, "sill_m", leaf.sill_m, 0, 0.55);
  RequireRange(path, "belt_m", leaf.belt_m, leaf.sill_m + 0.45, leaf.sill_m + 0.8);
  if (HasWindowFrame(leaf))
    RequireRange(path, "roof_m", leaf.roof_m, leaf.belt_m + 0.25, leaf.belt_m + 0.85);
  RequireRange(path, "front_slope_m", leaf.front_slope_m, 0, 0.45);
  RequireRange(path, "rear_slope_m", leaf.rear_slope_m, 0, 0.25);
  RequireRange(path, "tumblehome_m", leaf.tumblehome_m, 0, 0.34);
  RequireRange(path, "tuck_m", leaf.tuck_m, 0, 0.14);
  RequireRange(path, "bow_m", leaf.bow_m, 0, 0.04);
  RequireRange(path, "wheel_cut_m", leaf.wheel_cut_m, 0, 0.2);
  RequireRange(path, "crease_m", leaf.crease_m, -0.01, 0.012);
  RequireRange(path, "thickness_m", leaf.thickness_m, 0.05, 0.16);
  RequireRange(path, "frame_width_m", leaf.frame_width_m, 0.045, 0.1);
  RequireRange(path, "quarter_m", leaf.quarter_m, 0, 0.25);
  if (leaf.mirror_m > 0) {
    RequireRange(path, "mirror_m", leaf.mirror_m, 0.1, 0.3);
    RequireRange(path, "mirror_reach_m", leaf.mirror_reach_m, 0.12, 0.3);
  }
  RequireRange(path, "armrest_m", leaf.armrest_m, 0, 0.1);
  RequireRange(path, "pocket_m", leaf.pocket_m, 0, 0.1);
}

double SkinX(const CarLeafShape& leaf, double z) {
  const double widest = leaf.belt_m - kWidestBelowBeltM;
  const double down = Share(widest - z, 0, widest - leaf.sill_m);
  const double up = Share(z, widest, leaf.belt_m);
  const double above = HasWindowFrame(leaf) ? Share(z, leaf.belt_m, leaf.roof_m) : 0;
  return -leaf.tuck_m * down * down - 0.012 * up * up -
         leaf.tumblehome_m * (0.8 * above + 0.2 * above * above);
}

double FrontEnd(const CarLeafShape& leaf, double z) {
  if (!HasWindowFrame(leaf)) return 0;
  return leaf.front_slope_m * Share(z, leaf.belt_m, leaf.roof_m);
}

double RearEnd(const CarLeafShape& leaf, double z) {
  const double cut_from = leaf.belt_m - 0.3;
  const double cut = Share(cut_from - z, 0, cut_from - leaf.sill_m);
  const double lean = HasWindowFrame(leaf) ? Share(z, leaf.belt_m, leaf.roof_m) : 0;
  return leaf.length_m - leaf.wheel_cut_m * std::sqrt(cut) * (2 - std::sqrt(cut)) * 0.999 -
         leaf.rear_slope_m * lean;
}

double HingeEdgeX(const CarLeafShape& leaf) { return -leaf.bow_m + std::max(0.0, leaf.crease_m); }

Solid CarLeafSolid(const CarLeafShape& leaf) {
  PanelGrid grid;
  grid.openings = WindowsOf(leaf);
  grid.u_m = LinesAlongY(leaf, grid.openings);
  grid.v_m = LinesAlongZ(leaf, grid.openings);
  grid.edge_radius_m = kEdgeRadiusM;
  grid.front = [leaf](double u, double z) { return PointOf(leaf, u, z, -CreaseAt(leaf, z)); };
  grid.back = [leaf](double u, double z) { return PointOf(leaf, u, z, ThicknessAt(leaf, z)); };
  std::vector<Solid> solids = {PanelSolid(grid, kCarLeafHullToleranceM)};
  const double length = leaf.length_m;
  const double belt = leaf.belt_m;
  if (leaf.armrest_m > 0)
    solids.push_back(
        Pad(leaf, {{0.22 * length, belt - 0.31}, {0.72 * length, belt - 0.2}}, leaf.armrest_m));
  if (leaf.pocket_m > 0)
    solids.push_back(Pad(leaf, {{0.1 * length, leaf.sill_m + 0.06}, {0.7 * length, belt - 0.36}},
                         leaf.pocket_m));
  if (leaf.mirror_m > 0) solids.push_back(Mirror(leaf));
  return Joined(solids);
}

}  // namespace doorforge::internal
