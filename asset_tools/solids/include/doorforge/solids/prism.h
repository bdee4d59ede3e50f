// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/solids/solid.h"

// Solids from plane convex polygons: boards, shells with a cavity, closed hoops.

namespace doorforge::internal {

/// Convex and counter-clockwise unless said otherwise.
using Polygon = std::vector<Eigen::Vector2d>;

Polygon CirclePolygon(const Eigen::Vector2d& center_m, double radius_m, int points);
Polygon BoxPolygon(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m);
/// RoundedRectangle() between two corners.
Polygon RoundedBoxPolygon(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m,
                          double radius_m);

/// Every edge moved inwards (outwards if negative) by its own distance; as many points as before.
Polygon InsetEach(const Polygon& polygon, const std::vector<double>& distances_m);
Polygon Inset(const Polygon& polygon, double distance_m);

/// The part with (p - on_line) . outward <= 0; empty if there is none.
Polygon Clipped(const Polygon& polygon, const Eigen::Vector2d& on_line,
                const Eigen::Vector2d& outward);
/// The part with low <= p[axis] <= high.
Polygon ClippedToBand(const Polygon& polygon, int axis, double low, double high);

/// The polygon's coordinates are (y, z), (z, x) or (x, y) for a prism along x, y or z.
enum class PrismAxis { kX, kY, kZ };
struct PrismSpan {
  double low_m;
  double high_m;
};
/// One hull; both end faces have their border chamfered by `edge_m`. At most 32 points.
Solid ConvexPrism(const Polygon& polygon, PrismAxis axis, const PrismSpan& span, double edge_m);

/// A block along x with a cavity that opens to the front.
struct CupShape {
  Polygon outer;  ///< In (y, z).
  Polygon inner;  ///< It bounds the cavity and lies inside `outer`.
  /// The hulls are made of these, which follow the two above with fewer points: at most 30, and at
  /// most 24.
  Polygon outer_hull;
  Polygon inner_hull;
  double back_x_m;
  double floor_x_m;  ///< The cavity ends there.
  double front_x_m;
  double edge_radius_m;
};
Solid CupSolid(const CupShape& cup);

/// A closed hoop around the x axis through `center`: a rounded section moved along a circle.
struct HoopShape {
  double radius_m;      ///< The section's centre runs on it.
  double half_width_m;  ///< The section reaches so far along the radius to either side.
  double half_depth_m;  ///< Along x.
  double exponent = 2;  ///< It means what Section::exponent does.
  int sides = 40;
};
Solid HoopSolid(const HoopShape& hoop, const Eigen::Vector3d& center_m);

Solid Transformed(Solid solid, const RigidTransform& to_from_solid);

}  // namespace doorforge::internal
