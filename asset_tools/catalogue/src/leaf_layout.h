// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "doorforge/schemas/part.h"
#include "doorforge/solids/relief.h"

namespace doorforge::internal {

/// Rows and columns of fields between the stiles and rails of a framed leaf.
struct FieldGrid {
  double stile_width_m = 0.12;  ///< Upright at both edges; the handle sits on it.
  double bottom_rail_m = 0.18;
  double top_rail_m = 0.12;
  double bar_width_m = 0.1;  ///< Rails and uprights between fields.
  int columns = 2;
  std::vector<double> rows = {1.0};  ///< Relative heights from the bottom.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("stile_width_m", self.stile_width_m);
    visit("bottom_rail_m", self.bottom_rail_m);
    visit("top_rail_m", self.top_rail_m);
    visit("bar_width_m", self.bar_width_m);
    visit("columns", self.columns);
    visit("rows", self.rows);
  }
};

/// The fields row by row from the bottom, left to right. Throws Error(kInvalidConfig) if one would
/// be smaller than 4 cm; `path` names the grid.
std::vector<Rectangle> FieldsOf(const FieldGrid& grid, const Rectangle& leaf,
                                const std::string& path);

/// Upright V grooves that divide a leaf into planks, on the named face.
std::vector<ReliefField> PlankGrooves(const Rectangle& leaf, int planks, ReliefSide side);

/// The hinge of a body: axis -z (positive angles open towards x > 0), 0 to 86.4 degrees as in the
/// released objects. The line lies in front of the leaf's hinge edge, so the leaf swings free.
PartJoint BodyHinge(double leaf_edge_x_m);

/// Knuckles of butt hinges on the hinge line at the given heights.
Solid HingeKnuckles(const PartJoint& hinge, const std::vector<double>& heights_m);

}  // namespace doorforge::internal
