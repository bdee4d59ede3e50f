// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "repair/triangle_crossing.h"

#include <cmath>
#include <cstddef>

#include <CGAL/intersections.h>
#include <Eigen/Geometry>

#include "repair/surface_mesh.h"

namespace doorforge {
namespace {

using Three = std::array<Point, 3>;

Three PointsOf(const CornerTriangle& triangle) {
  Three points;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d& at = triangle.points[k];
    points[k] = Point(at.x(), at.y(), at.z());
  }
  return points;
}

// The places in both triangles of the corners that they share.
struct CommonCorners {
  CommonCorners(const CornerTriangle& s, const CornerTriangle& t) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (s.corners[i] != t.corners[k]) continue;
        in_s[count] = i;
        in_t[count++] = k;
      }
    }
  }

  std::array<std::size_t, 3> in_s{}, in_t{};
  std::size_t count = 0;
};

// Whether those of the corners that are not common lie on one side of the other triangle's plane
// beyond doubt, so that the two share nothing else.
bool IsBeside(const CornerTriangle& triangle, const CornerTriangle& plane,
              const std::array<std::size_t, 3>& common, std::size_t count) {
  constexpr double kDoubt = 1e-12;  // of the product of lengths: rounding, a thousand times
  const Eigen::Vector3d u = plane.points[1] - plane.points[0];
  const Eigen::Vector3d v = plane.points[2] - plane.points[0];
  const Eigen::Vector3d normal = u.cross(v);
  const double doubt = kDoubt * std::sqrt(u.squaredNorm() * v.squaredNorm());
  bool all_above = true, all_below = true;
  for (std::size_t k = 0; k < 3; ++k) {
    if (count > 0 && k == common[0]) continue;
    const Eigen::Vector3d way = triangle.points[k] - plane.points[0];
    const double side = normal.dot(way);
    const double least = doubt * way.cwiseAbs().sum();
    all_above = all_above && side > least;
    all_below = all_below && side < -least;
  }
  return all_above || all_below;
}

// Two that share an edge cross only where one is folded onto the other.
bool AreFolded(const Three& s, const Three& t, const CommonCorners& common) {
  const Point& a = s[common.in_s[0]];
  const Point& b = s[common.in_s[1]];
  const Point& c = s[3 - common.in_s[0] - common.in_s[1]];
  const Point& d = t[3 - common.in_t[0] - common.in_t[1]];
  return CGAL::orientation(a, b, c, d) == CGAL::COPLANAR &&
         CGAL::coplanar_orientation(a, b, c, d) == CGAL::POSITIVE;
}

Kernel::Segment_3 Opposite(const Three& points, std::size_t corner) {
  return {points[(corner + 1) % 3], points[(corner + 2) % 3]};
}

}  // namespace

bool IsLine(const CornerTriangle& triangle) {
  const Three points = PointsOf(triangle);
  return CGAL::collinear(points[0], points[1], points[2]);
}

bool TrianglesCross(const CornerTriangle& s, const CornerTriangle& t) {
  const CommonCorners common(s, t);
  if (common.count == 3) return true;
  if (common.count == 2) return AreFolded(PointsOf(s), PointsOf(t), common);
  if (IsBeside(s, t, common.in_s, common.count) || IsBeside(t, s, common.in_t, common.count))
    return false;
  const Three of_s = PointsOf(s), of_t = PointsOf(t);
  const Kernel::Triangle_3 whole_s(of_s[0], of_s[1], of_s[2]);
  const Kernel::Triangle_3 whole_t(of_t[0], of_t[1], of_t[2]);
  if (common.count == 0) return CGAL::do_intersect(whole_s, whole_t);
  return CGAL::do_intersect(whole_s, Opposite(of_t, common.in_t[0])) ||
         CGAL::do_intersect(whole_t, Opposite(of_s, common.in_s[0]));
}

}  // namespace doorforge
