// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "cut_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace doorforge::internal {
namespace {

constexpr double kOnPlane = 1e-7;     // [m]
constexpr double kOnePoint = 1e-6;    // [m] within which vertices become one
constexpr double kThinnest = 0.0005;  // [m] of what is worth keeping

/// Cuts one mesh: vertices that stay are numbered anew, edges that cross give one vertex each, so
/// that the triangles of both sides of an edge share it.
class PlaneCut {
 public:
  PlaneCut(const TriangleMesh& hull, const Eigen::Vector3d& normal, double distance) : hull_(hull) {
    for (const Eigen::Vector3d& vertex : hull.vertices) {
      const double height = normal.dot(vertex) - distance;
      heights_.push_back(std::abs(height) < kOnPlane ? kOnPlane : height);
    }
  }

  TriangleMesh Cut() {
    for (const Eigen::Vector3i& triangle : hull_.triangles) CutTriangle(triangle);
    AddCap();
    return std::move(cut_);
  }

 private:
  int Kept(int vertex) {
    const auto [entry, is_new] = kept_.try_emplace(vertex, static_cast<int>(cut_.vertices.size()));
    if (is_new) cut_.vertices.push_back(hull_.vertices[static_cast<std::size_t>(vertex)]);
    return entry->second;
  }

  int Crossing(int a, int b) {
    if (a > b) std::swap(a, b);
    const auto [entry, is_new] =
        crossings_.try_emplace({a, b}, static_cast<int>(cut_.vertices.size()));
    if (is_new) {
      const double ha = heights_[static_cast<std::size_t>(a)];
      const double hb = heights_[static_cast<std::size_t>(b)];
      const Eigen::Vector3d& va = hull_.vertices[static_cast<std::size_t>(a)];
      const Eigen::Vector3d& vb = hull_.vertices[static_cast<std::size_t>(b)];
      cut_.vertices.push_back(va + ha / (ha - hb) * (vb - va));
    }
    return entry->second;
  }

  void CutTriangle(const Eigen::Vector3i& triangle) {
    std::vector<int> polygon;
    int leaves = -1;
    int enters = -1;
    for (int k = 0; k < 3; ++k) {
      const int a = triangle[k];
      const int b = triangle[(k + 1) % 3];
      const bool a_stays = heights_[static_cast<std::size_t>(a)] < 0;
      const bool b_stays = heights_[static_cast<std::size_t>(b)] < 0;
      if (a_stays) polygon.push_back(Kept(a));
      if (a_stays == b_stays) continue;
      polygon.push_back(Crossing(a, b));
      (a_stays ? leaves : enters) = polygon.back();
    }
    for (std::size_t k = 2; k < polygon.size(); ++k)
      cut_.triangles.emplace_back(polygon[0], polygon[k - 1], polygon[k]);
    if (leaves >= 0) cap_[enters] = leaves;
  }

  // Each triangle that was cut gave one side of the section. All meet in its middle: a fan about a
  // corner would have triangles without area, where corners of earlier cuts lie on one line.
  void AddCap() {
    if (cap_.size() < 3) return;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const auto& [corner, next] : cap_)
      middle += cut_.vertices[static_cast<std::size_t>(corner)] / static_cast<double>(cap_.size());
    const auto apex = static_cast<int>(cut_.vertices.size());
    cut_.vertices.push_back(middle);
    for (const auto& [corner, next] : cap_) cut_.triangles.emplace_back(apex, corner, next);
  }

  const TriangleMesh& hull_;
  std::vector<double> heights_;  // of the hull's vertices above the plane
  TriangleMesh cut_;
  std::map<int, int> kept_;
  std::map<std::pair<int, int>, int> crossings_;
  std::map<int, int> cap_;  // from each corner of the section to the next
};

// For each vertex the first one that lies within kOnePoint of it.
std::vector<int> FirstOfEachPoint(const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<int> first;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    std::size_t same = 0;
    while ((vertices[same] - vertices[i]).norm() > kOnePoint) ++same;
    first.push_back(first.size() > same ? first[same] : static_cast<int>(i));
  }
  return first;
}

// The smallest index first, so that equal triangles are equal.
std::array<int, 3> Turned(const Eigen::Vector3i& triangle) {
  std::array<int, 3> turned{triangle[0], triangle[1], triangle[2]};
  std::ranges::rotate(turned, std::ranges::min_element(turned));
  return turned;
}

// Where a plane passes a hair from a vertex, vertices are one point in a file and triangles have no
// area. Sides of an edge that became one point fall together; two triangles that lie back to back
// then enclose nothing.
TriangleMesh Welded(const TriangleMesh& mesh) {
  const std::vector<int> first = FirstOfEachPoint(mesh.vertices);
  std::set<std::array<int, 3>> triangles;
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const Eigen::Vector3i joined(first[static_cast<std::size_t>(triangle[0])],
                                 first[static_cast<std::size_t>(triangle[1])],
                                 first[static_cast<std::size_t>(triangle[2])]);
    if (joined[0] == joined[1] || joined[1] == joined[2] || joined[2] == joined[0]) continue;
    const auto back = triangles.find(Turned({joined[0], joined[2], joined[1]}));
    if (back != triangles.end())
      triangles.erase(back);
    else
      triangles.insert(Turned(joined));
  }
  TriangleMesh welded;
  std::map<int, int> index;
  for (const std::array<int, 3>& triangle : triangles) {
    Eigen::Vector3i kept;
    for (int k = 0; k < 3; ++k) {
      const int vertex = triangle[static_cast<std::size_t>(k)];
      const auto [entry, is_new] =
          index.try_emplace(vertex, static_cast<int>(welded.vertices.size()));
      if (is_new) welded.vertices.push_back(mesh.vertices[static_cast<std::size_t>(vertex)]);
      kept[k] = entry->second;
    }
    welded.triangles.push_back(kept);
  }
  return welded;
}

Eigen::AlignedBox3d BoundsIn(const RigidTransform& box_from_frame, const TriangleMesh& mesh) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices) bounds.extend(box_from_frame * vertex);
  return bounds;
}

bool IsWorthKeeping(const RigidTransform& box_from_frame, const TriangleMesh& piece) {
  return piece.triangles.size() >= 4 &&
         BoundsIn(box_from_frame, piece).sizes().minCoeff() > kThinnest;
}

}  // namespace

TriangleMesh CutByPlane(const TriangleMesh& hull, const Eigen::Vector3d& normal, double distance) {
  return Welded(PlaneCut(hull, normal, distance).Cut());
}

std::vector<TriangleMesh> WithoutBox(const TriangleMesh& hull, const PlacedBox& box) {
  const RigidTransform box_from_frame = box.frame_from_box.inverse();
  std::vector<TriangleMesh> pieces;
  TriangleMesh rest = hull;
  for (int axis = 1; axis <= 3; ++axis) {  // y first: what lies behind stays whole
    for (const double sign : {1.0, -1.0}) {
      const int k = axis % 3;
      const double limit = sign > 0 ? box.bounds.max()[k] : -box.bounds.min()[k];
      const Eigen::Vector3d normal = sign * box.frame_from_box.linear().col(k);
      const double distance = limit + normal.dot(box.frame_from_box.translation());
      TriangleMesh beyond = CutByPlane(rest, -normal, -distance);
      if (IsWorthKeeping(box_from_frame, beyond)) pieces.push_back(std::move(beyond));
      rest = CutByPlane(rest, normal, distance);
      if (rest.triangles.empty()) return {hull};  // they do not meet
    }
  }
  return pieces;
}

}  // namespace doorforge::internal
