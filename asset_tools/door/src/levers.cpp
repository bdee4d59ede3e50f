// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "handle_base.h"
#include "sweep.h"

namespace doorforge::internal {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kHullToleranceM = 0.001;

/// What all levers share: a round neck out of the rose, a bend, a bar towards the hinge.
struct Lever {
  double length_m = 0.125;      ///< From the handle's axis to the tip, along y.
  double projection_m = 0.052;  ///< From the leaf to the bar's centre line.
  double bar_height_m = 0.02;   ///< Along z.
  double bar_depth_m = 0.012;   ///< Along x.
  double squareness = 2;        ///< Exponent of the section: 2 ellipse, 8 nearly a rectangle.
  double tip_scale = 1;         ///< Bar height at the tip relative to its root.
  double neck_diameter_m = 0.018;
  double bend_radius_m = 0.014;
  RoseParameters rose;
  std::string finish = "brushed_steel";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("length_m", self.length_m);
    visit("projection_m", self.projection_m);
    visit("bar_height_m", self.bar_height_m);
    visit("bar_depth_m", self.bar_depth_m);
    visit("squareness", self.squareness);
    visit("tip_scale", self.tip_scale);
    visit("neck_diameter_m", self.neck_diameter_m);
    visit("bend_radius_m", self.bend_radius_m);
    visit("rose", self.rose);
    visit("finish", self.finish);
  }
};

struct CurvedLever : Lever {
  double bow_m = 0.006;  ///< Outward bulge of the bar's middle; negative bends towards the leaf.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Lever::VisitFields(self, visit);
    visit("bow_m", self.bow_m);
  }
};

struct WaveLever : Lever {
  double wave_m = 0.008;  ///< Height of the wave in the plane of the leaf.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Lever::VisitFields(self, visit);
    visit("wave_m", self.wave_m);
  }
};

struct ReturnedLever : Lever {
  double end_gap_m = 0.014;  ///< Between the returned end and the leaf.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Lever::VisitFields(self, visit);
    visit("end_gap_m", self.end_gap_m);
  }
};

void Check(const Lever& lever, const std::string& path) {
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

// Distance of the bar from its straight line (x: out, z: up) at fraction t of the bar; zero with
// zero slope at t = 0.
using BarShape = std::function<Eigen::Vector2d(double)>;

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

// From the round neck to the bar's section over the bend.
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
  const double bend_end = bend_begin + lever.bend_radius_m * kPi / 2 / total;
  const auto section = [&](double fraction) {
    return LeverSection(lever, fraction, bend_begin, bend_end);
  };
  const double dome = std::min(lever.bar_depth_m, lever.bar_height_m) * 0.35;
  const auto rings = SweepRings(line, Eigen::Vector3d::UnitZ(), section, dome);
  part.pieces.push_back(
      MakePiece("grip", LoftSolid(rings, kHullToleranceM), lever.finish, path + ".finish"));
  part.joint = HandleJoint(true);
  part.part_from_grasp = GraspAt(PointAtY(line, -0.57 * lever.length_m), Closing::kVertical);
  part.grasp_half_extent_m = {0.18 * lever.length_m, 0.004, lever.bar_depth_m / 2 + 0.003};
  return part;
}

Part BuildStraight(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<Lever>(json, path);
  Check(lever, path);
  return LeverPart(lever, path, [&](double start_x) { return LeverPath(lever, start_x, nullptr); });
}

Part BuildCurved(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<CurvedLever>(json, path);
  Check(lever, path);
  RequireRange(path, "bow_m", lever.bow_m, -0.012, 0.016);
  const BarShape bow = [&](double t) {
    return Eigen::Vector2d(
        lever.bow_m * (0.5 - 0.5 * std::cos(2 * kPi * t)) - 0.25 * lever.bow_m * t * t, 0);
  };
  return LeverPart(lever, path, [&](double start_x) { return LeverPath(lever, start_x, bow); });
}

Part BuildWave(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<WaveLever>(json, path);
  Check(lever, path);
  RequireRange(path, "wave_m", lever.wave_m, 0.002, 0.014);
  const BarShape wave = [&](double t) {
    return Eigen::Vector2d(0, 1.3 * lever.wave_m * t * std::sin(2 * kPi * t));
  };
  return LeverPart(lever, path, [&](double start_x) { return LeverPath(lever, start_x, wave); });
}

Part BuildReturned(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<ReturnedLever>(json, path);
  Check(lever, path);
  RequireRange(path, "end_gap_m", lever.end_gap_m, 0.008, 0.03);
  const double dome = std::min(lever.bar_depth_m, lever.bar_height_m) * 0.35;
  const double end_y = -(lever.length_m - lever.bar_depth_m / 2);
  return LeverPart(lever, path, [&](double start_x) {
    return FilletedPath({{start_x, 0, 0},
                         {lever.projection_m, 0, 0},
                         {lever.projection_m, end_y, 0},
                         {lever.end_gap_m + dome, end_y, 0}},
                        lever.bend_radius_m);
  });
}

}  // namespace

std::span<const Family> LeverFamilies() {
  static const Family kFamilies[] = {
      {"lever_straight", PartRole::kHandle, Mechanism::kLever, BuildStraight},
      {"lever_curved", PartRole::kHandle, Mechanism::kLever, BuildCurved},
      {"lever_wave", PartRole::kHandle, Mechanism::kLever, BuildWave},
      {"lever_returned", PartRole::kHandle, Mechanism::kLever, BuildReturned},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
