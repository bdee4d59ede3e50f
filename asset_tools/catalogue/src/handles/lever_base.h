// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "doorforge/solids/sweep.h"

#include "handles/handle_base.h"

namespace doorforge::internal {

inline constexpr double kLeverHullToleranceM = 0.001;

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

/// Throws Error(kInvalidConfig) on a number out of range; `path` names the lever.
void CheckLever(const Lever& lever, const std::string& path);

/// Distance of the bar from its straight line (x: out, y of the vector: up) at fraction t of the
/// bar; zero with zero slope at t = 0.
using BarShape = std::function<Eigen::Vector2d(double)>;

/// Out of the rose at `start_x`, around the bend and along the bar to the tip.
std::vector<PathPoint> LeverPath(const Lever& lever, double start_x, const BarShape& shape);

/// From the round neck to the bar's section over the bend; all arguments but the lever are
/// fractions of the path's length.
Section LeverSection(const Lever& lever, double fraction, double bend_begin, double bend_end);

/// The point of a path where it passes y towards the hinge.
Eigen::Vector3d PointAtY(const std::vector<PathPoint>& path, double y);

/// Rose and a grip swept along `centre_line(start_x)`, with joint and grasp.
Part LeverPart(const Lever& lever, const std::string& path,
               const std::function<std::vector<PathPoint>(double)>& centre_line);

/// Joint and grasp of a lever held around `at`, with `bar_depth_m` of material there.
void FinishLever(const Lever& lever, const Eigen::Vector3d& at, Part& part);

}  // namespace doorforge::internal
