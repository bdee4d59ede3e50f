// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "doorforge/core/named_enum.h"
#include "doorforge/solids/prism.h"
#include "doorforge/solids/relief.h"

// Frames around any convex outline in the plane of a leaf, and bars inside them.

namespace doorforge::internal {

/// How an outline ends above.
enum class HeadKind {
  kFlat,
  kSegment,     ///< It is an arc that rises by `rise_m`.
  kRound,       ///< It is half an ellipse.
  kPointed,     ///< Two arcs meet.
  kSlantLeft,   ///< The left side is lower by the rise.
  kSlantRight,  ///< The right side is lower by the rise.
};
inline constexpr NamedValue<HeadKind> kHeadKindWords[] = {{HeadKind::kFlat, "flat"},
                                                          {HeadKind::kSegment, "segment"},
                                                          {HeadKind::kRound, "round"},
                                                          {HeadKind::kPointed, "pointed"},
                                                          {HeadKind::kSlantLeft, "slant_left"},
                                                          {HeadKind::kSlantRight, "slant_right"}};
constexpr std::span<const NamedValue<HeadKind>> ValuesOf(HeadKind) { return kHeadKindWords; }

/// The upper end of a window.
struct HeadShape {
  HeadKind shape = HeadKind::kFlat;
  double rise_m = 0;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("shape", self.shape);
    visit("rise_m", self.rise_m);
  }
};

/// Counter-clockwise in (y, z); the head's highest point touches the rectangle's upper side. Throws
/// Error(kInvalidConfig) on a rise of more than 0.6 of the height.
Polygon OutlineWithHead(const Rectangle& box, const HeadShape& head, const std::string& path);

/// What stands for a section in hulls: a rectangle in (u, x), and how far the hulls of a curved
/// outline may stand out.
struct HoopBox {
  Rectangle section;
  double tolerance_m = 0.0065;
};

/// A section moved around an outline, with mitred corners. `section` is in (u, x), u outwards from
/// the outline, counter-clockwise; the boxes together cover it.
Solid OutlineHoop(const Polygon& outline, const Polygon& section,
                  const std::vector<HoopBox>& boxes);

struct BarGrid {
  int columns = 2;
  int rows = 2;
  double width_m = 0.03;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("columns", self.columns);
    visit("rows", self.rows);
    visit("width_m", self.width_m);
  }
};

/// Bars that divide what is inside a convex outline into columns and rows: upright ones right
/// through, the others between them. Solids touch, they do not overlap.
Solid BarsInside(const Polygon& outline, const BarGrid& grid, const PrismSpan& depth);

/// Bars like rays from a point on the outline's lower side, and an arc of bars at `hub_m` around
/// it. The outline must be as good as symmetrical about the point.
Solid RaysInside(const Polygon& outline, int rays, double hub_m, const BarGrid& grid,
                 const PrismSpan& depth);

}  // namespace doorforge::internal
