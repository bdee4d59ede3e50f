// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "doorforge/solids/solid.h"

namespace doorforge::internal {

/// A rectangle in the plane of a leaf; x of the vectors is y of the part, y is z of the part.
struct Rectangle {
  Eigen::Vector2d min_m;
  Eigen::Vector2d max_m;
};

/// How a face rises or sinks with the distance from a rectangle's border.
struct ReliefStep {
  double distance_m;  ///< From the border, not negative; rising within a profile.
  double height_m;    ///< Positive is out of the face.
};
using ReliefProfile = std::vector<ReliefStep>;

enum class ReliefSide { kFront, kBack, kBoth };

/// A moulding inside a rectangle: height by the profile at the distance from the nearest side, so
/// corners are mitred; further inside the last height holds. Profiles begin at height 0.
struct ReliefField {
  Rectangle area;
  ReliefProfile profile;
  ReliefSide side = ReliefSide::kBoth;
};

/// A slab with mouldings on its faces and openings through it, as one closed solid. It fills
/// x in [-thickness, 0] before the mouldings; the front face is x = 0.
struct ReliefSlab {
  Rectangle outline;
  double thickness_m = 0.04;
  double edge_radius_m = 0.003;     ///< Rounds the outline's edges on both faces; may be 0.
  std::vector<ReliefField> fields;  ///< Must not overlap each other or the openings.
  std::vector<Rectangle> openings;  ///< Right through; their edges are rounded too.
  /// Places along y and z where the mesh is cut beside those it needs: for what is bent later.
  std::vector<double> extra_cuts_m[2] = {};
};

/// Hulls are boxes: fields, openings and the ground between them cut the slab into rectangles, and
/// neighbours whose depth differs by less than `hull_tolerance_m` are joined.
Solid ReliefSolid(const ReliefSlab& slab, double hull_tolerance_m);

/// A panel sunk by `depth_m` behind a slope of `slope_m` (the flat field of a framed door).
ReliefProfile SunkPanel(double depth_m, double slope_m);
/// A groove around a field that rises again to `field_depth_m` below the ground over `bevel_m`.
ReliefProfile RaisedPanel(double groove_depth_m, double field_depth_m, double bevel_m);

}  // namespace doorforge::internal
