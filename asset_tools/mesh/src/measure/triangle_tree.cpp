// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "measure/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "doorforge/mesh/work_budget.h"

#include "measure/nearest_point.h"

namespace doorforge {
namespace {

using Eigen::Vector3d;

constexpr int kLeafTriangles = 4;
constexpr std::size_t kDeepest = 64;  // more than the levels of halves of any number of triangles

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Where the ray meets the triangle from either side, or infinity: Moller and Trumbore (1997).
double RayHit(const Vector3d& origin, const Vector3d& direction,
              const std::array<const Vector3d*, 3>& corner) {
  const Vector3d ab = *corner[1] - *corner[0];
  const Vector3d ac = *corner[2] - *corner[0];
  const Vector3d p = direction.cross(ac);
  const double determinant = ab.dot(p);
  if (determinant == 0) return kInfinity;
  const Vector3d from_a = origin - *corner[0];
  const double u = from_a.dot(p) / determinant;
  if (!(u >= 0 && u <= 1)) return kInfinity;
  const Vector3d q = from_a.cross(ab);
  const double v = direction.dot(q) / determinant;
  return v >= 0 && u + v <= 1 ? ac.dot(q) / determinant : kInfinity;
}

// Where the ray enters the box, or infinity.
double BoxEntry(const Vector3d& origin, const Vector3d& inverse, const Eigen::AlignedBox3d& box) {
  double near = 0;
  double far = kInfinity;
  for (int k = 0; k < 3; ++k) {
    const double t0 = (box.min()[k] - origin[k]) * inverse[k];
    const double t1 = (box.max()[k] - origin[k]) * inverse[k];
    // a NaN (0 times infinity: the ray runs in the face) leaves the bound as it is
    near = std::max(near, std::min(t0, t1));
    far = std::min(far, std::max(t0, t1));
  }
  return near <= far * (1 + 1e-12) ? near : kInfinity;
}

// Runs along no edge and no face of what is drawn by hand.
const Vector3d kRay = Vector3d(0.8377, 0.4211, 0.3479).normalized();

// On which side of the ray the edge passes: -1 or 1, or 0 within rounding.
int SideOf(const Vector3d& from_a, const Vector3d& from_b) {
  constexpr double kRounding = 1e-12;  // of a triple product, with room to spare
  const double side = from_a.cross(from_b).dot(kRay);
  if (side * side <= kRounding * kRounding * from_a.squaredNorm() * from_b.squaredNorm()) return 0;
  return side > 0 ? 1 : -1;
}

// Whether the ray from the origin may meet the box, grown by `margin_m`.
bool RayMeets(const Vector3d& origin, const Eigen::AlignedBox3d& box, double margin_m) {
  double near = 0;
  double far = kInfinity;
  for (int k = 0; k < 3; ++k) {
    near = std::max(near, (box.min()[k] - margin_m - origin[k]) / kRay[k]);
    far = std::min(far, (box.max()[k] + margin_m - origin[k]) / kRay[k]);
  }
  return near <= far;
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  triangles_.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& t : mesh.triangles)
    triangles_.push_back({mesh.vertices[static_cast<std::size_t>(t[0])],
                          mesh.vertices[static_cast<std::size_t>(t[1])],
                          mesh.vertices[static_cast<std::size_t>(t[2])]});
  nodes_.reserve(triangles_.size());
  nodes_.emplace_back();
  Build(0, 0, static_cast<int>(triangles_.size()));
  if (!triangles_.empty()) touch_m_ = 1e-9 * nodes_[0].box.diagonal().norm();
}

void TriangleTree::Build(int node, int first, int count) {
  Eigen::AlignedBox3d box;
  Eigen::AlignedBox3d centers;
  for (int i = first; i < first + count; ++i) {
    const Triangle& t = triangles_[static_cast<std::size_t>(i)];
    box.extend(t.a).extend(t.b).extend(t.c);
    centers.extend(t.a + t.b + t.c);
  }
  nodes_[static_cast<std::size_t>(node)] = {box, first, count};
  if (count <= kLeafTriangles) return;
  int axis = 0;
  centers.sizes().maxCoeff(&axis);
  const auto begin = triangles_.begin() + first;
  const int half = count / 2;
  std::nth_element(begin, begin + half, begin + count,
                   [axis](const Triangle& s, const Triangle& t) {
                     return s.a[axis] + s.b[axis] + s.c[axis] < t.a[axis] + t.b[axis] + t.c[axis];
                   });
  const int child = static_cast<int>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[static_cast<std::size_t>(node)].first = child;
  nodes_[static_cast<std::size_t>(node)].count = 0;
  Build(child, first, half);
  Build(child + 1, first + half, count - half);
}

double TriangleTree::Distance(const Vector3d& point, double at_most) const {
  return NearestTriangle(point, at_most).distance_m;
}

double TriangleTree::DistanceTo(int triangle, const Vector3d& point) const {
  const Triangle& t = triangles_[static_cast<std::size_t>(triangle)];
  return (point - NearestPoint(point, t.a, t.b, t.c)).norm();
}

TriangleTree::Near TriangleTree::NearestTriangle(const Vector3d& point, double at_most) const {
  double best = at_most * at_most;
  int nearest = -1;
  if (triangles_.empty()) return {nearest, at_most};
  struct Pending {
    double bound;
    int node;
  };
  std::array<Pending, kDeepest> pending;
  std::size_t count = 0;
  pending[count++] = {0, 0};
  unsigned visited = 0;
  while (count > 0) {
    const Pending next = pending[--count];
    if (next.bound >= best) continue;
    ++visited;
    const Node& node = nodes_[static_cast<std::size_t>(next.node)];
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Triangle& t = triangles_[static_cast<std::size_t>(i)];
      const double squared = (point - NearestPoint(point, t.a, t.b, t.c)).squaredNorm();
      if (squared < best) best = squared, nearest = i;
    }
    if (node.count > 0) continue;
    Pending near{nodes_[static_cast<std::size_t>(node.first)].box.squaredExteriorDistance(point),
                 node.first};
    Pending far{nodes_[static_cast<std::size_t>(node.first) + 1].box.squaredExteriorDistance(point),
                node.first + 1};
    if (far.bound < near.bound) std::swap(near, far);
    if (far.bound < best) pending[count++] = far;
    if (near.bound < best) pending[count++] = near;
  }
  CheckWork(visited);
  return {nearest, std::sqrt(best)};
}

bool TriangleTree::Hits(const Vector3d& origin, const Vector3d& direction, double from_m) const {
  return Nearest(origin, direction, from_m, true) < kInfinity;
}

double TriangleTree::FirstHit(const Vector3d& origin, const Vector3d& direction,
                              double from_m) const {
  return Nearest(origin, direction, from_m, false);
}

double TriangleTree::Nearest(const Vector3d& origin, const Vector3d& direction, double from_m,
                             bool any) const {
  double best = kInfinity;
  if (triangles_.empty()) return best;
  const Vector3d inverse = direction.cwiseInverse();
  std::vector<int> pending{0};
  while (!pending.empty()) {
    CheckWork(1);
    const Node& node = nodes_[static_cast<std::size_t>(pending.back())];
    pending.pop_back();
    if (!(BoxEntry(origin, inverse, node.box) < best)) continue;
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Triangle& t = triangles_[static_cast<std::size_t>(i)];
      const double hit = RayHit(origin, direction, {&t.a, &t.b, &t.c});
      if (hit > from_m) best = std::min(best, hit);
      if (any && best < kInfinity) return best;
    }
    if (node.count > 0) continue;
    pending.push_back(node.first);
    pending.push_back(node.first + 1);
  }
  return best;
}

double TriangleTree::WindingNumber(const Vector3d& point) const {
  // solid angles: Van Oosterom and Strackee (1983)
  double angle = 0;
  CheckWork(static_cast<unsigned>(4 * triangles_.size()));
  for (const Triangle& t : triangles_) {
    const Vector3d a = t.a - point;
    const Vector3d b = t.b - point;
    const Vector3d c = t.c - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    angle +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (2 * std::numbers::pi);
}

bool TriangleTree::IsInside(const Vector3d& point) const {
  const std::optional<int> sheets = SheetsBeyond(point);
  return sheets ? *sheets > 0 : WindingNumber(point) > 0.5;
}

std::optional<int> TriangleTree::SheetsBeyond(const Vector3d& point) const {
  int sheets = 0;
  std::vector<int> pending;
  if (!triangles_.empty()) pending.push_back(0);
  while (!pending.empty()) {
    CheckWork(1);
    const Node& node = nodes_[static_cast<std::size_t>(pending.back())];
    pending.pop_back();
    if (!RayMeets(point, node.box, touch_m_)) continue;
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Triangle& t = triangles_[static_cast<std::size_t>(i)];
      const Vector3d a = t.a - point;
      const Vector3d b = t.b - point;
      const Vector3d c = t.c - point;
      const std::array<int, 3> sides = {SideOf(a, b), SideOf(b, c), SideOf(c, a)};
      const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
      if (*least < 0 && *most > 0) continue;
      if (*least == 0 || *most == 0) return std::nullopt;
      const Vector3d normal = (b - a).cross(c - a);
      const double ahead_m = normal.dot(a) / normal.dot(kRay);
      if (!(std::abs(ahead_m) > touch_m_)) return std::nullopt;
      if (ahead_m > 0) sheets += *most;
    }
    if (node.count > 0) continue;
    pending.push_back(node.first);
    pending.push_back(node.first + 1);
  }
  return sheets;
}

}  // namespace doorforge
