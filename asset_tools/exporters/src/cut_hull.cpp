// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "cut_hull.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace doorforge::internal {
namespace {

constexpr double kOnPlane = 1e-7;     // [m]
constexpr double kThinnest = 0.0005;  // [m] of what is worth keeping

/// Cuts one mesh: vertices that stay are numbered anew, edges that cross give one vertex each, so
/// that the triangles of both sides of an edge share it.
class PlaneCut {
 public:
  PlaneCut(const TriangleMesh& hull, const Eigen::Vector3d& normal, double distance)
      : hull_(hull), normal_(normal) {
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
    for (int k = 0; k < 3; ++k) {
      const int a = triangle[k];
      const int b = triangle[(k + 1) % 3];
      const bool a_stays = heights_[static_cast<std::size_t>(a)] < 0;
      const bool b_stays = heights_[static_cast<std::size_t>(b)] < 0;
      if (a_stays) polygon.push_back(Kept(a));
      if (a_stays != b_stays) polygon.push_back(Crossing(a, b));
    }
    for (std::size_t k = 2; k < polygon.size(); ++k)
      cut_.triangles.emplace_back(polygon[0], polygon[k - 1], polygon[k]);
  }

  // The section of a convex mesh is convex: its corners in the order of their angles.
  void AddCap() {
    if (crossings_.size() < 3) return;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const auto& [edge, corner] : crossings_) middle += At(corner);
    middle /= static_cast<double>(crossings_.size());
    const Eigen::Vector3d u = normal_.unitOrthogonal();
    const Eigen::Vector3d v = normal_.cross(u);
    std::vector<std::pair<double, int>> corners;
    for (const auto& [edge, corner] : crossings_) {
      const Eigen::Vector3d away = At(corner) - middle;
      corners.emplace_back(std::atan2(v.dot(away), u.dot(away)), corner);
    }
    std::sort(corners.begin(), corners.end());
    for (std::size_t k = 2; k < corners.size(); ++k)
      cut_.triangles.emplace_back(corners[0].second, corners[k - 1].second, corners[k].second);
  }

  const Eigen::Vector3d& At(int corner) const {
    return cut_.vertices[static_cast<std::size_t>(corner)];
  }

  const TriangleMesh& hull_;
  Eigen::Vector3d normal_;
  std::vector<double> heights_;  // of the hull's vertices above the plane
  TriangleMesh cut_;
  std::map<int, int> kept_;
  std::map<std::pair<int, int>, int> crossings_;
};

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
  return PlaneCut(hull, normal, distance).Cut();
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
