// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <CGAL/alpha_wrap_3.h>
#include <Eigen/Geometry>

#include "doorforge/mesh/work_budget.h"

#include "measure/nearest_point.h"
#include "repair/surface_mesh.h"
#include "repair/surface_operations.h"

namespace doorforge {
namespace {

namespace wraps = CGAL::Alpha_wraps_3::internal;

Eigen::Vector3d VectorOf(const Point& point) { return {point.x(), point.y(), point.z()}; }

// The triangles of a wrap's input, to be found by place. CGAL's own tree spends most of a wrap on
// boxes around the same ball, at each of its nodes anew, and is exact where distances are rounded
// anyway.
class FoundTriangles {
 public:
  struct Triangle {
    std::array<Eigen::Vector3d, 3> corners;
    Kernel::Triangle_3 exact;
  };

  explicit FoundTriangles(const TriangleMesh& soup) {
    const std::vector<Point> points = PointsOf(soup);
    const auto at = [&](int i) -> const Point& { return points[static_cast<std::size_t>(i)]; };
    for (const Eigen::Vector3i& t : soup.triangles) {
      const Kernel::Triangle_3 exact(at(t[0]), at(t[1]), at(t[2]));
      if (exact.is_degenerate()) continue;
      triangles_.push_back({{VectorOf(at(t[0])), VectorOf(at(t[1])), VectorOf(at(t[2]))}, exact});
    }
    nodes_.emplace_back();
    Build(0, 0, static_cast<int>(triangles_.size()));
  }

  // Whether `meets` says so of a triangle; those in boxes that `may_meet` excludes are not asked.
  template <class MayMeet, class Meets>
  bool Any(const MayMeet& may_meet, const Meets& meets) const {
    std::array<int, kDeepest> pending;
    std::size_t count = 0;
    pending[count++] = 0;
    while (count > 0) {
      const Node& node = nodes_[static_cast<std::size_t>(pending[--count])];
      if (!may_meet(node.box)) continue;
      for (int i = node.first; i < node.first + node.count; ++i) {
        if (meets(triangles_[static_cast<std::size_t>(i)])) return true;
      }
      if (node.count > 0) continue;
      pending[count++] = node.first;
      pending[count++] = node.first + 1;
    }
    return false;
  }

  // The point of the triangles that is nearest to another.
  Eigen::Vector3d NearestTo(const Eigen::Vector3d& point) const {
    Nearest nearest;
    Descend(0, point, nearest);
    return nearest.point;
  }

 private:
  static constexpr std::size_t kDeepest = 64;  // more than the levels of halves

  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0;  // leaf: first triangle; inner: first child, the second follows it
    int count = 0;  // leaf: triangles; inner: 0
  };

  struct Nearest {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    double squared_m2 = std::numeric_limits<double>::infinity();
  };

  // The nearer child first.
  void Descend(int at, const Eigen::Vector3d& point, Nearest& nearest) const {
    const Node& node = nodes_[static_cast<std::size_t>(at)];
    for (int i = node.first; i < node.first + node.count; ++i) {
      const auto& [a, b, c] = triangles_[static_cast<std::size_t>(i)].corners;
      const Eigen::Vector3d candidate = NearestPoint(point, a, b, c);
      const double squared_m2 = (candidate - point).squaredNorm();
      if (squared_m2 < nearest.squared_m2) nearest = {candidate, squared_m2};
    }
    if (node.count > 0) return;
    const auto away = [&](int child) {
      return nodes_[static_cast<std::size_t>(child)].box.squaredExteriorDistance(point);
    };
    std::array<std::pair<double, int>, 2> children = {
        {{away(node.first), node.first}, {away(node.first + 1), node.first + 1}}};
    if (children[1].first < children[0].first) std::swap(children[0], children[1]);
    for (const auto& [squared_m2, child] : children) {
      if (squared_m2 < nearest.squared_m2) Descend(child, point, nearest);
    }
  }

  void Build(int node, int first, int count) {
    constexpr int kLeafTriangles = 2;
    Eigen::AlignedBox3d box, centers;
    const auto begin = triangles_.begin() + first;
    const auto center = [](const Triangle& t) -> Eigen::Vector3d {
      return t.corners[0] + t.corners[1] + t.corners[2];
    };
    for (auto t = begin; t != begin + count; ++t) {
      for (const Eigen::Vector3d& corner : t->corners) box.extend(corner);
      centers.extend(center(*t));
    }
    nodes_[static_cast<std::size_t>(node)] = {box, first, count};
    if (count <= kLeafTriangles) return;
    Eigen::Index axis = 0;
    centers.sizes().maxCoeff(&axis);
    const int half = count / 2;
    std::nth_element(begin, begin + half, begin + count, [&](const Triangle& s, const Triangle& t) {
      return center(s)[axis] < center(t)[axis];
    });
    const int child = static_cast<int>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[static_cast<std::size_t>(node)].first = child;
    nodes_[static_cast<std::size_t>(node)].count = 0;
    Build(child, first, half);
    Build(child + 1, first + half, count - half);
  }

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

// The planes of a tetrahedron's faces, to tell beyond doubt that it is apart from a triangle.
class TetrahedronPlanes {
 public:
  explicit TetrahedronPlanes(const Kernel::Tetrahedron_3& shape) {
    std::array<Eigen::Vector3d, 4> corners;
    for (int k = 0; k < 4; ++k) corners[static_cast<std::size_t>(k)] = VectorOf(shape.vertex(k));
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector3d& at = corners[(k + 1) % 4];
      const Eigen::Vector3d u = corners[(k + 2) % 4] - at;
      const Eigen::Vector3d v = corners[(k + 3) % 4] - at;
      Plane plane{u.cross(v), at, kDoubt * std::sqrt(u.squaredNorm() * v.squaredNorm())};
      const Eigen::Vector3d across = corners[k] - at;
      const double side = plane.normal.dot(across);
      if (!(std::abs(side) > plane.doubt * SizeOf(across))) continue;  // flat
      if (side > 0) plane.normal = -plane.normal;
      planes_[static_cast<std::size_t>(count_++)] = plane;
    }
  }

  // True only if all corners lie beyond one plane; it may be false of a triangle that is apart.
  bool Part(const std::array<Eigen::Vector3d, 3>& corners) const {
    return std::any_of(planes_.begin(), planes_.begin() + count_, [&](const Plane& plane) {
      return std::all_of(corners.begin(), corners.end(), [&](const Eigen::Vector3d& corner) {
        const Eigen::Vector3d way = corner - plane.at;
        return plane.normal.dot(way) > plane.doubt * SizeOf(way);
      });
    });
  }

 private:
  static constexpr double kDoubt = 1e-12;  // of the product of lengths: rounding, a thousand times

  struct Plane {
    Eigen::Vector3d normal, at;  // of no particular length, outwards
    double doubt = 0;
  };

  static double SizeOf(const Eigen::Vector3d& way) { return way.cwiseAbs().sum(); }

  std::array<Plane, 4> planes_;
  std::ptrdiff_t count_ = 0;
};

// How far a point is from the triangles, as CGAL's search along a segment asks for it.
struct DistanceTo {
  double operator()(const Point& point) const {
    const Eigen::Vector3d at = VectorOf(point);
    return (found->NearestTo(at) - at).norm();
  }

  const FoundTriangles* found;
};

// What a wrap asks of its input, with the answers that CGAL's own function would be given but for
// rounding of nearest points; between two questions a wrap that takes too long can be given up.
// CGAL 5.5 offers no other place for that.
class SoupWithinBudget : public wraps::Triangle_soup_oracle<Kernel> {
 public:
  using Base = wraps::Triangle_soup_oracle<Kernel>;
  using Point_3 = Geom_traits::Point_3;

  SoupWithinBudget(double alpha_m, const TriangleMesh& soup)
      : Base(alpha_m, Kernel()), found_(soup) {
    add_triangle_soup(PointsOf(soup), PolygonsOf(soup));
  }

  bool do_intersect(const Geom_traits::Ball_3& ball) const {
    CheckWork(kSteps / 4);
    // beyond doubt where it is not within a billionth: distances are rounded
    constexpr double kDoubt = 1e-9;
    const Eigen::Vector3d center = VectorOf(ball.boundary().center());
    const double squared = ball.boundary().squared_radius();
    return found_.Any(
        [&](const Eigen::AlignedBox3d& box) {
          return box.squaredExteriorDistance(center) <= (1 + kDoubt) * squared;
        },
        [&](const FoundTriangles::Triangle& t) {
          const double way =
              (center - NearestPoint(center, t.corners[0], t.corners[1], t.corners[2]))
                  .squaredNorm();
          if (std::abs(way - squared) > kDoubt * squared) return way < squared;
          return geom_traits().do_intersect_3_object()(ball, t.exact);
        });
  }

  template <class K>
  bool do_intersect(const wraps::Tetrahedron_with_outside_info<K>& shape) const {
    CheckWork(kSteps / 4);
    const Eigen::AlignedBox3d around(
        Eigen::Vector3d(shape.m_bbox.xmin(), shape.m_bbox.ymin(), shape.m_bbox.zmin()),
        Eigen::Vector3d(shape.m_bbox.xmax(), shape.m_bbox.ymax(), shape.m_bbox.zmax()));
    const TetrahedronPlanes planes(shape.m_tet);
    return found_.Any([&](const Eigen::AlignedBox3d& box) { return box.intersects(around); },
                      [&](const FoundTriangles::Triangle& t) {
                        return !planes.Part(t.corners) &&
                               geom_traits().do_intersect_3_object()(shape, t.exact);
                      });
  }

  Point_3 closest_point(const Point_3& point) const {
    CheckWork(kSteps / 4);
    const Eigen::Vector3d nearest = found_.NearestTo(VectorOf(point));
    return {nearest.x(), nearest.y(), nearest.z()};
  }

  bool first_intersection(const Point_3& from, const Point_3& to, Point_3& at,
                          const Geom_traits::FT offset) const {
    constexpr double kPrecision = 0.01;  // of the offset, as CGAL's own
    CheckWork(kSteps);
    return wraps::Offset_intersection<Geom_traits, DistanceTo>(DistanceTo{&found_}, offset,
                                                               kPrecision * offset, 1)
        .first_intersection(from, to, at);
  }

 private:
  static constexpr unsigned kSteps = 1000;

  FoundTriangles found_;
};

}  // namespace

TriangleMesh AlphaWrap(const TriangleMesh& soup, double alpha_m, double offset_m) {
  SurfaceMesh wrap;
  const SoupWithinBudget oracle(alpha_m, soup);
  wraps::Alpha_wrap_3<SoupWithinBudget> builder(oracle);
  builder(alpha_m, offset_m, wrap);
  wrap.collect_garbage();
  return TrianglesOf(wrap);
}

}  // namespace doorforge
