// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "car_leaf.h"

#include <algorithm>
#include <cmath>

#include "family.h"

namespace doorforge::internal {
namespace {

constexpr double kEdgeRadiusM = 0.008;
constexpr double kHullToleranceM = 0.006;
constexpr double kFrameThicknessM = 0.034;  // of the window frame
constexpr double kWidestBelowBeltM = 0.2;   // height of the widest line
constexpr double kCreaseBelowBeltM = 0.27;  // below any handle
constexpr double kCreaseHalfWidthM = 0.03;

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
  if (!HasWindowFrame(leaf)) return {};
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
  if (!windows.empty()) {
    borders.push_back(windows.front().min_m.y());
    borders.push_back(windows.front().max_m.y());
    const std::vector<double> upper =
        EqualLines(windows.front().min_m.y(), windows.front().max_m.y(), 4);
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

}  // namespace

bool HasWindowFrame(const CarLeafShape& leaf) { return leaf.roof_m > leaf.belt_m + 0.01; }

void CheckCarLeaf(const CarLeafShape& leaf, const std::string& path) {
  RequireRange(path, "length_m", leaf.length_m, 0.95, 1.32);
  RequireRange(path, "sill_m", leaf.sill_m, 0, 0.55);
  RequireRange(path, "belt_m", leaf.belt_m, leaf.sill_m + 0.45, leaf.sill_m + 0.8);
  if (HasWindowFrame(leaf))
    RequireRange(path, "roof_m", leaf.roof_m, leaf.belt_m + 0.25, leaf.belt_m + 0.75);
  RequireRange(path, "front_slope_m", leaf.front_slope_m, 0, 0.45);
  RequireRange(path, "rear_slope_m", leaf.rear_slope_m, 0, 0.25);
  RequireRange(path, "tumblehome_m", leaf.tumblehome_m, 0, 0.2);
  RequireRange(path, "tuck_m", leaf.tuck_m, 0, 0.05);
  RequireRange(path, "bow_m", leaf.bow_m, 0, 0.02);
  RequireRange(path, "wheel_cut_m", leaf.wheel_cut_m, 0, 0.2);
  RequireRange(path, "crease_m", leaf.crease_m, -0.01, 0.012);
  RequireRange(path, "thickness_m", leaf.thickness_m, 0.05, 0.085);
  RequireRange(path, "frame_width_m", leaf.frame_width_m, 0.045, 0.1);
  RequireRange(path, "quarter_m", leaf.quarter_m, 0, 0.25);
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
  const auto point = [leaf](double u, double z, double depth) {
    const double share = u / leaf.length_m;
    const double begin = FrontEnd(leaf, z);
    const double y = begin + share * (RearEnd(leaf, z) - begin);
    const double bow = leaf.bow_m * std::pow(2 * share - 1, 2);
    return Eigen::Vector3d(SkinX(leaf, z) - bow - depth, y, z);
  };
  grid.front = [leaf, point](double u, double z) {
    return Eigen::Vector3d(point(u, z, -CreaseAt(leaf, z)));
  };
  grid.back = [leaf, point](double u, double z) {
    return Eigen::Vector3d(point(u, z, ThicknessAt(leaf, z)));
  };
  return PanelSolid(grid, kHullToleranceM);
}

}  // namespace doorforge::internal
