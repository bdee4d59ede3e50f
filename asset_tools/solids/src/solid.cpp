// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/solids/solid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/mesh/convex_parts.h"

namespace doorforge::internal {
namespace {

constexpr std::size_t kMaxHullVertices = 64;

Eigen::Vector3d CenterOf(const Ring& ring) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : ring) sum += point;
  return sum / static_cast<double>(ring.size());
}

// The tube between the rings: open at both ends.
TriangleMesh Tube(const std::vector<Ring>& rings) {
  Require(rings.size() >= 2 && rings[0].size() >= 3, ErrorCode::kInvalidArgument,
          "a loft needs at least two rings of three points");
  TriangleMesh mesh;
  const int count = static_cast<int>(rings[0].size());
  for (const Ring& ring : rings) {
    Require(ring.size() == rings[0].size(), ErrorCode::kInvalidArgument,
            "all rings of a loft have the same number of points");
    mesh.vertices.insert(mesh.vertices.end(), ring.begin(), ring.end());
  }
  for (int i = 0; i + 1 < static_cast<int>(rings.size()); ++i) {
    for (int k = 0; k < count; ++k) {
      const int next = (k + 1) % count;
      const int a = i * count + k;
      const int b = i * count + next;
      const int c = a + count;
      const int d = b + count;
      mesh.triangles.emplace_back(a, b, d);
      mesh.triangles.emplace_back(a, d, c);
    }
  }
  return mesh;
}

double Cross(const Eigen::Vector2d& o, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

bool IsEar(const std::vector<Eigen::Vector2d>& profile, const std::vector<int>& left,
           std::size_t at) {
  const std::size_t n = left.size();
  const int ia = left[(at + n - 1) % n];
  const int ib = left[at];
  const int ic = left[(at + 1) % n];
  const auto point = [&](int i) { return profile[static_cast<std::size_t>(i)]; };
  if (Cross(point(ia), point(ib), point(ic)) <= 0) return false;
  return std::none_of(left.begin(), left.end(), [&](int i) {
    if (i == ia || i == ib || i == ic) return false;
    return Cross(point(ia), point(ib), point(i)) >= 0 &&
           Cross(point(ib), point(ic), point(i)) >= 0 && Cross(point(ic), point(ia), point(i)) >= 0;
  });
}

// Triangles of a simple counter-clockwise polygon, by ear clipping.
std::vector<Eigen::Vector3i> EarClipped(const std::vector<Eigen::Vector2d>& profile) {
  std::vector<int> left;
  for (std::size_t i = 0; i < profile.size(); ++i) left.push_back(static_cast<int>(i));
  std::vector<Eigen::Vector3i> triangles;
  while (left.size() > 2) {
    std::size_t ear = 0;
    while (ear < left.size() && !IsEar(profile, left, ear)) ++ear;
    Require(ear < left.size(), ErrorCode::kInvalidArgument,
            "the profile of a loft crosses itself or runs clockwise");
    const std::size_t n = left.size();
    triangles.emplace_back(left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

// Depth of the deepest of the points below the surface of the convex hull.
double DeepestBelow(const TriangleMesh& hull, const std::vector<Eigen::Vector3d>& points) {
  double deepest = 0;
  for (const Eigen::Vector3d& point : points) {
    double depth = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3i& t : hull.triangles) {
      const Eigen::Vector3d a = hull.vertices[static_cast<std::size_t>(t[0])];
      const Eigen::Vector3d b = hull.vertices[static_cast<std::size_t>(t[1])];
      const Eigen::Vector3d c = hull.vertices[static_cast<std::size_t>(t[2])];
      depth = std::min(depth, -(point - a).dot((b - a).cross(c - a).normalized()));
    }
    deepest = std::max(deepest, depth);
  }
  return deepest;
}

// Points of the loft's side surface between rings first and last: vertices and quad centres.
std::vector<Eigen::Vector3d> SidePoints(const std::vector<Ring>& rings, std::size_t first,
                                        std::size_t last) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = first; i <= last; ++i) {
    points.insert(points.end(), rings[i].begin(), rings[i].end());
    if (i == last) break;
    for (std::size_t k = 0; k < rings[i].size(); ++k) {
      const std::size_t next = (k + 1) % rings[i].size();
      points.push_back((rings[i][k] + rings[i][next] + rings[i + 1][k] + rings[i + 1][next]) / 4);
    }
  }
  return points;
}

TriangleMesh HullOf(const std::vector<Ring>& rings, std::size_t first, std::size_t last) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = first; i <= last; ++i)
    points.insert(points.end(), rings[i].begin(), rings[i].end());
  return ConvexHull(points);
}

Ring PlateRing(const std::vector<Eigen::Vector2d>& outline, const Eigen::Vector2d& center,
               double x) {
  Ring ring;
  for (const Eigen::Vector2d& p : outline)
    ring.emplace_back(x, center.x() + p.x(), center.y() + p.y());
  return ring;
}

}  // namespace

TriangleMesh Loft(const std::vector<Ring>& rings) {
  TriangleMesh mesh = Tube(rings);
  const int count = static_cast<int>(rings[0].size());
  const int last = (static_cast<int>(rings.size()) - 1) * count;
  const int start_center = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back(CenterOf(rings.front()));
  mesh.vertices.push_back(CenterOf(rings.back()));
  for (int k = 0; k < count; ++k) {
    const int next = (k + 1) % count;
    mesh.triangles.emplace_back(next, k, start_center);
    mesh.triangles.emplace_back(last + k, last + next, start_center + 1);
  }
  return mesh;
}

TriangleMesh LoftLoop(const std::vector<Ring>& rings) {
  std::vector<Ring> around = rings;
  around.push_back(rings.front());
  TriangleMesh mesh = Tube(around);
  // the repeated ring is the first one
  const int count = static_cast<int>(rings[0].size());
  const int end = static_cast<int>(mesh.vertices.size()) - count;
  mesh.vertices.resize(static_cast<std::size_t>(end));
  for (Eigen::Vector3i& t : mesh.triangles) {
    for (int& index : t) index = index >= end ? index - end : index;
  }
  return mesh;
}

TriangleMesh LoftProfile(const std::vector<Ring>& rings,
                         const std::vector<Eigen::Vector2d>& profile) {
  TriangleMesh mesh = Tube(rings);
  const int last = (static_cast<int>(rings.size()) - 1) * static_cast<int>(rings[0].size());
  for (const Eigen::Vector3i& t : EarClipped(profile)) {
    mesh.triangles.emplace_back(t[0], t[2], t[1]);
    mesh.triangles.emplace_back(t[0] + last, t[1] + last, t[2] + last);
  }
  return mesh;
}

std::vector<TriangleMesh> LoftHulls(const std::vector<Ring>& rings, double tolerance_m) {
  std::vector<TriangleMesh> hulls;
  std::size_t first = 0;
  while (first + 1 < rings.size()) {
    std::size_t last = first + 1;
    TriangleMesh hull = HullOf(rings, first, last);
    for (std::size_t next = last + 1; next < rings.size(); ++next) {
      TriangleMesh longer = HullOf(rings, first, next);
      if (longer.vertices.size() > kMaxHullVertices ||
          DeepestBelow(longer, SidePoints(rings, first, next)) > tolerance_m)
        break;
      hull = std::move(longer);
      last = next;
    }
    hulls.push_back(std::move(hull));
    first = last;
  }
  return hulls;
}

Solid LoftSolid(const std::vector<Ring>& rings, double hull_tolerance_m) {
  return {Loft(rings), LoftHulls(rings, hull_tolerance_m)};
}

TriangleMesh BoxMesh(const Eigen::Vector3d& min_m, const Eigen::Vector3d& max_m) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1) != 0 ? max_m.x() : min_m.x(),
                               (i & 2) != 0 ? max_m.y() : min_m.y(),
                               (i & 4) != 0 ? max_m.z() : min_m.z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Solid Joined(const std::vector<Solid>& solids) {
  Solid all;
  for (const Solid& solid : solids) {
    const int offset = static_cast<int>(all.mesh.vertices.size());
    all.mesh.vertices.insert(all.mesh.vertices.end(), solid.mesh.vertices.begin(),
                             solid.mesh.vertices.end());
    for (const Eigen::Vector3i& t : solid.mesh.triangles)
      all.mesh.triangles.emplace_back(t.array() + offset);
    all.hulls.insert(all.hulls.end(), solid.hulls.begin(), solid.hulls.end());
  }
  return all;
}

Solid Moved(Solid solid, const Eigen::Vector3d& offset_m) {
  for (Eigen::Vector3d& vertex : solid.mesh.vertices) vertex += offset_m;
  for (TriangleMesh& hull : solid.hulls) {
    for (Eigen::Vector3d& vertex : hull.vertices) vertex += offset_m;
  }
  return solid;
}

std::vector<Eigen::Vector2d> RoundedRectangle(const Eigen::Vector2d& half_size_m, double radius_m,
                                              int segments) {
  const Eigen::Vector2d inner = half_size_m.array() - radius_m;
  std::vector<Eigen::Vector2d> outline;
  for (int corner = 0; corner < 4; ++corner) {
    const Eigen::Vector2d center(corner == 0 || corner == 3 ? inner.x() : -inner.x(),
                                 corner < 2 ? inner.y() : -inner.y());
    for (int i = 0; i <= segments; ++i) {
      const double angle = std::numbers::pi / 2 * (corner + static_cast<double>(i) / segments);
      const Eigen::Vector2d point =
          center + radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      // a stadium's neighbouring arcs meet in one point
      if (outline.empty() || (point - outline.back()).norm() > 1e-9) outline.push_back(point);
    }
  }
  if ((outline.front() - outline.back()).norm() < 1e-9) outline.pop_back();
  return outline;
}

Solid PlateSolid(const PlateShape& shape, const Eigen::Vector2d& center) {
  constexpr int kCornerSegments = 6;
  constexpr int kEdgeSegments = 3;
  const auto ring = [&](double x, double inset, int segments) {
    const Eigen::Vector2d half = shape.half_size_m.array() - inset;
    return PlateRing(RoundedRectangle(half, shape.corner_radius_m - inset, segments), center, x);
  };
  std::vector<Ring> rings = {ring(0, 0, kCornerSegments)};
  const double edge = shape.edge_radius_m;
  for (int i = 0; i <= kEdgeSegments; ++i) {
    const double angle = std::numbers::pi / 2 * i / kEdgeSegments;
    rings.push_back(ring(shape.thickness_m - edge + edge * std::sin(angle),
                         edge * (1 - std::cos(angle)), kCornerSegments));
  }
  const std::vector<Ring> prism = {ring(0, 0, kCornerSegments),
                                   ring(shape.thickness_m, 0, kCornerSegments)};
  return {Loft(rings), LoftHulls(prism, 0)};
}

Solid ChamferedBox(const Eigen::Vector3d& min_m, const Eigen::Vector3d& max_m, double edge_m) {
  const Eigen::Vector3d center = (min_m + max_m) / 2;
  const Eigen::Vector3d half = (max_m - min_m) / 2;
  const auto ring = [&](double x, double inset) {
    const Eigen::Vector2d size(half.y() - inset, half.z() - inset);
    return PlateRing(RoundedRectangle(size, edge_m, 1), {center.y(), center.z()}, x);
  };
  const std::vector<Ring> rings = {ring(min_m.x(), edge_m), ring(min_m.x() + edge_m, 0),
                                   ring(max_m.x() - edge_m, 0), ring(max_m.x(), edge_m)};
  return {Loft(rings), {BoxMesh(min_m, max_m)}};
}

}  // namespace doorforge::internal
