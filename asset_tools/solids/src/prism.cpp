// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/solids/prism.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/LU>

#include "doorforge/core/error.h"
#include "doorforge/solids/sweep.h"

namespace doorforge::internal {
namespace {

Eigen::Vector2d Direction(const Polygon& polygon, std::size_t i) {
  return (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
}

// The normal that points out of a counter-clockwise polygon.
Eigen::Vector2d Outward(const Eigen::Vector2d& direction) {
  return {direction.y(), -direction.x()};
}

Eigen::Vector3d OnAxis(PrismAxis axis, const Eigen::Vector2d& p, double along) {
  if (axis == PrismAxis::kX) return {along, p.x(), p.y()};
  if (axis == PrismAxis::kY) return {p.y(), along, p.x()};
  return {p.x(), p.y(), along};
}

Ring RingOf(const Polygon& polygon, PrismAxis axis, double along) {
  Ring ring;
  for (const Eigen::Vector2d& p : polygon) ring.push_back(OnAxis(axis, p, along));
  return ring;
}

// From `center` in direction `angle` to the polygon's border.
Eigen::Vector2d BorderAt(const Polygon& polygon, const Eigen::Vector2d& center, double angle) {
  const Eigen::Vector2d ray(std::cos(angle), std::sin(angle));
  double reach = 1e9;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d normal = Outward(Direction(polygon, i));
    const double speed = normal.dot(ray);
    if (speed > 1e-9) reach = std::min(reach, normal.dot(polygon[i] - center) / speed);
  }
  return center + reach * ray;
}

Polygon BorderAt(const Polygon& polygon, const Eigen::Vector2d& center,
                 const std::vector<double>& angles) {
  Polygon border;
  for (const double angle : angles) border.push_back(BorderAt(polygon, center, angle));
  return border;
}

Eigen::Vector2d MiddleOf(const Polygon& polygon) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : polygon) sum += p;
  return sum / static_cast<double>(polygon.size());
}

// Directions of all corners of both polygons, so that neither loses one.
std::vector<double> CornerAngles(const CupShape& cup, const Eigen::Vector2d& center) {
  std::vector<double> angles;
  for (const Polygon* polygon : {&cup.outer, &cup.inner}) {
    for (const Eigen::Vector2d& p : *polygon)
      angles.push_back(std::atan2(p.y() - center.y(), p.x() - center.x()));
  }
  std::sort(angles.begin(), angles.end());
  std::vector<double> kept;
  for (const double angle : angles) {
    if (kept.empty() || angle - kept.back() > 0.004) kept.push_back(angle);
  }
  return kept;
}

// The block around the cavity, one convex piece for each side of the cavity.
std::vector<TriangleMesh> CupHulls(const CupShape& cup) {
  std::vector<TriangleMesh> hulls;
  const auto add = [&](const Polygon& polygon, double low, double high) {
    const Solid prism = ConvexPrism(polygon, PrismAxis::kX, {low, high}, 0);
    hulls.insert(hulls.end(), prism.hulls.begin(), prism.hulls.end());
  };
  add(cup.outer_hull, cup.back_x_m, cup.floor_x_m);
  Polygon left = cup.outer_hull;
  for (std::size_t i = 0; i < cup.inner_hull.size(); ++i) {
    const Eigen::Vector2d normal = Outward(Direction(cup.inner_hull, i));
    const Polygon wall = Clipped(left, cup.inner_hull[i], -normal);
    left = Clipped(left, cup.inner_hull[i], normal);
    if (wall.size() >= 3) add(wall, cup.floor_x_m, cup.front_x_m);
  }
  return hulls;
}

}  // namespace

Polygon CirclePolygon(const Eigen::Vector2d& center_m, double radius_m, int points) {
  Polygon polygon;
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / points;
    polygon.emplace_back(center_m + radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

Polygon BoxPolygon(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m) {
  return {min_m, {max_m.x(), min_m.y()}, max_m, {min_m.x(), max_m.y()}};
}

Polygon RoundedBoxPolygon(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m,
                          double radius_m) {
  Polygon polygon = RoundedRectangle((max_m - min_m) / 2, radius_m, 6);
  for (Eigen::Vector2d& p : polygon) p += (min_m + max_m) / 2;
  return polygon;
}

Polygon InsetEach(const Polygon& polygon, const std::vector<double>& distances_m) {
  const std::size_t n = polygon.size();
  Require(distances_m.size() == n, ErrorCode::kInvalidArgument, "an inset has one number an edge");
  Polygon inset;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = (i + n - 1) % n;
    const Eigen::Vector2d normal_a = Outward(Direction(polygon, before));
    const Eigen::Vector2d normal_b = Outward(Direction(polygon, i));
    Eigen::Matrix2d lines;
    lines << normal_a.transpose(), normal_b.transpose();
    const Eigen::Vector2d offsets(normal_a.dot(polygon[i]) - distances_m[before],
                                  normal_b.dot(polygon[i]) - distances_m[i]);
    inset.emplace_back(lines.inverse() * offsets);
  }
  return inset;
}

Polygon Inset(const Polygon& polygon, double distance_m) {
  return InsetEach(polygon, std::vector<double>(polygon.size(), distance_m));
}

// Sutherland and Hodgman, 1974, for one line.
Polygon Clipped(const Polygon& polygon, const Eigen::Vector2d& on_line,
                const Eigen::Vector2d& outward) {
  constexpr double kTouchM = 1e-7;
  Polygon kept;
  const auto outside = [&](const Eigen::Vector2d& p) { return (p - on_line).dot(outward); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    const double out_a = outside(a);
    const double out_b = outside(b);
    if (out_a <= kTouchM) kept.push_back(a);
    if ((out_a < -kTouchM && out_b > kTouchM) || (out_a > kTouchM && out_b < -kTouchM))
      kept.emplace_back(a + (b - a) * (out_a / (out_a - out_b)));
  }
  // what only touches the line has no area
  const bool inside = std::any_of(kept.begin(), kept.end(), [&](const Eigen::Vector2d& p) {
    return outside(p) < -10 * kTouchM;
  });
  return inside ? kept : Polygon{};
}

Polygon ClippedToBand(const Polygon& polygon, int axis, double low, double high) {
  const Eigen::Vector2d along = axis == 0 ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY();
  return Clipped(Clipped(polygon, along * high, along), along * low, -along);
}

Solid ConvexPrism(const Polygon& polygon, PrismAxis axis, const PrismSpan& span, double edge_m) {
  const std::vector<Ring> prism = {RingOf(polygon, axis, span.low_m),
                                   RingOf(polygon, axis, span.high_m)};
  std::vector<TriangleMesh> hulls = LoftHulls(prism, 0);
  if (edge_m <= 0) return {Loft(prism), std::move(hulls)};
  const Polygon end = Inset(polygon, edge_m);
  const std::vector<Ring> rings = {
      RingOf(end, axis, span.low_m), RingOf(polygon, axis, span.low_m + edge_m),
      RingOf(polygon, axis, span.high_m - edge_m), RingOf(end, axis, span.high_m)};
  return {Loft(rings), std::move(hulls)};
}

Solid CupSolid(const CupShape& cup) {
  const Eigen::Vector2d center = MiddleOf(cup.inner);
  const std::vector<double> angles = CornerAngles(cup, center);
  const auto ring = [&](const Polygon& polygon, double x) {
    return RingOf(BorderAt(polygon, center, angles), PrismAxis::kX, x);
  };
  const double r = cup.edge_radius_m;
  std::vector<Ring> rings = {ring(Inset(cup.outer, r), cup.back_x_m),
                             ring(cup.outer, cup.back_x_m + r)};
  for (const double degrees : {0.0, 30.0, 60.0, 90.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    rings.push_back(ring(Inset(cup.outer, r * (1 - std::cos(angle))),
                         cup.front_x_m - r * (1 - std::sin(angle))));
  }
  const double bevel = std::min(r, 0.002);
  rings.push_back(ring(Inset(cup.inner, -bevel), cup.front_x_m));
  rings.push_back(ring(cup.inner, cup.front_x_m - bevel));
  rings.push_back(ring(cup.inner, cup.floor_x_m));
  return {Loft(rings), CupHulls(cup)};
}

Solid HoopSolid(const HoopShape& hoop, const Eigen::Vector3d& center_m) {
  std::vector<PathPoint> path;
  for (int i = 0; i < hoop.sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / hoop.sides;
    const Eigen::Vector3d out(0, std::cos(angle), std::sin(angle));
    const Eigen::Vector3d tangent(0, -std::sin(angle), std::cos(angle));
    path.push_back({center_m + hoop.radius_m * out, tangent, static_cast<double>(i)});
  }
  const Section section{hoop.half_width_m, hoop.half_depth_m, hoop.exponent};
  std::vector<Ring> rings = SweepRings(
      path, Eigen::Vector3d::UnitX(), [&](double) { return section; }, 0);
  TriangleMesh mesh = LoftLoop(rings);
  rings.push_back(rings.front());
  return {std::move(mesh), LoftHulls(rings, 0.0025)};
}

Solid Transformed(Solid solid, const RigidTransform& to_from_solid) {
  for (Eigen::Vector3d& vertex : solid.mesh.vertices) vertex = to_from_solid * vertex;
  for (TriangleMesh& hull : solid.hulls) {
    for (Eigen::Vector3d& vertex : hull.vertices) vertex = to_from_solid * vertex;
  }
  return solid;
}

}  // namespace doorforge::internal
