// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "handles/lever_base.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace doorforge::internal {

void CheckLever(const Lever& lever, const std::string& path) {
  RequireRange(path, "length_m", lever.length_m, 0.09, 0.15);
  RequireRange(path, "projection_m", lever.projection_m, 0.042, 0.07);
  RequireRange(path, "bar_height_m", lever.bar_height_m, 0.01, 0.034);
  RequireRange(path, "bar_depth_m", lever.bar_depth_m, 0.007, 0.024);
  RequireRange(path, "squareness", lever.squareness, 2, 10);
  RequireRange(path, "tip_scale", lever.tip_scale, 0.5, 1.4);
  RequireRange(path, "neck_diameter_m", lever.neck_diameter_m, 0.012, 0.024);
  const double inner = std::max(lever.neck_diameter_m, lever.bar_depth_m) / 2;
  RequireRange(path, "bend_radius_m", lever.bend_radius_m, inner + 0.001, 0.03);
}

std::vector<PathPoint> LeverPath(const Lever& lever, double start_x, const BarShape& shape) {
  const double x = lever.projection_m;
  std::vector<PathPoint> path =
      FilletedPath({{start_x, 0, 0}, {x, 0, 0}, {x, -lever.length_m, 0}}, lever.bend_radius_m);
  path.pop_back();
  const double from = lever.bend_radius_m;
  const int steps = shape ? 12 : 1;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const Eigen::Vector2d offset = shape ? shape(t) : Eigen::Vector2d::Zero();
    points.emplace_back(x + offset.x(), -from - t * (lever.length_m - from), offset.y());
  }
  const Eigen::Vector3d last = points.back() - points[points.size() - 2];
  const std::vector<PathPoint> bar =
      SmoothPath(points, -Eigen::Vector3d::UnitY(), last.normalized());
  const double bend_length = path.back().length_m;
  for (std::size_t i = 1; i < bar.size(); ++i) {
    path.push_back(bar[i]);
    path.back().length_m += bend_length;
  }
  return path;
}

Section LeverSection(const Lever& lever, double fraction, double bend_begin, double bend_end) {
  const double t = std::clamp((fraction - bend_begin) / (bend_end - bend_begin), 0.0, 1.0);
  const double smooth = t * t * (3 - 2 * t);
  const double along = std::clamp((fraction - bend_end) / (1 - bend_end), 0.0, 1.0);
  const double scale = 1 + (lever.tip_scale - 1) * along;
  const auto mix = [&](double neck, double bar) { return neck + (bar - neck) * smooth; };
  return {mix(lever.neck_diameter_m / 2, lever.bar_depth_m / 2),
          mix(lever.neck_diameter_m / 2, lever.bar_height_m / 2 * scale), mix(2, lever.squareness)};
}

Eigen::Vector3d PointAtY(const std::vector<PathPoint>& path, double y) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector3d& a = path[i - 1].position_m;
    const Eigen::Vector3d& b = path[i].position_m;
    if (b.y() > y || a.y() <= b.y()) continue;
    return a + (b - a) * ((a.y() - y) / (a.y() - b.y()));
  }
  return path.back().position_m;
}

Part LeverPart(const Lever& lever, const std::string& path,
               const std::function<std::vector<PathPoint>(double)>& centre_line) {
  Part part;
  const double start_x = AddRose(lever.rose, path + ".rose", part);
  const std::vector<PathPoint> line = centre_line(start_x);
  const double total = line.back().length_m;
  const double bend_begin = (lever.projection_m - start_x - lever.bend_radius_m) / total;
  const double bend_end = bend_begin + lever.bend_radius_m * std::numbers::pi / 2 / total;
  const auto section = [&](double fraction) {
    return LeverSection(lever, fraction, bend_begin, bend_end);
  };
  const double dome = std::min(lever.bar_depth_m, lever.bar_height_m) * 0.35;
  const auto rings = TransportedSweepRings(line, Eigen::Vector3d::UnitZ(), section, dome);
  part.pieces.push_back(
      MakePiece("grip", LoftSolid(rings, kLeverHullToleranceM), lever.finish, path + ".finish"));
  FinishLever(lever, PointAtY(line, -0.57 * lever.length_m), part);
  return part;
}

void FinishLever(const Lever& lever, const Eigen::Vector3d& at, Part& part) {
  part.joint = HandleJoint(true);
  part.part_from_grasp = GraspAt(at, Closing::kVertical);
  part.grasp_half_extent_m = {0.18 * lever.length_m, 0.004, lever.bar_depth_m / 2 + 0.003};
}

}  // namespace doorforge::internal
