// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "doorforge/solids/relief.h"

namespace doorforge::internal {

/// A curved panel with openings, as one closed solid: a grid of lines in plane coordinates (u, v),
/// each node of which has a point on the panel's front and one on its back.
struct PanelGrid {
  std::vector<double> u_m;          ///< Ascending lines; see EdgeLines().
  std::vector<double> v_m;          ///< They divide the other side likewise.
  std::vector<Rectangle> openings;  ///< In (u, v); bounded by lines.
  double edge_radius_m = 0.004;     ///< All borders on front and back have it; it may be 0.

  /// Front and back at a node, not yet rounded at the borders. Right-handed: du x dv points from
  /// the back to the front.
  std::function<Eigen::Vector3d(double u, double v)> front;
  std::function<Eigen::Vector3d(double u, double v)> back;
};

/// `lines` with those beside each border that its rounding needs. `borders` are where the panel or
/// an opening ends along this direction; they must be farther apart than two radii. What lies
/// within a radius of a border goes.
std::vector<double> EdgeLines(const std::vector<double>& lines, const std::vector<double>& borders,
                              double radius_m);

/// Equal steps from low to high, both included.
std::vector<double> EqualLines(double low, double high, int steps);

/// Hulls are those of rectangles of cells, joined as long as they stand out by no more than
/// `hull_tolerance_m` where the panel bends inwards and have at most 64 vertices.
Solid PanelSolid(const PanelGrid& grid, double hull_tolerance_m);

}  // namespace doorforge::internal
