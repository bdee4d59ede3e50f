// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "collision/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <Eigen/Geometry>
#include <LinearMath/btConvexHullComputer.h>

namespace doorforge::internal {
namespace {

double SizeOf(const std::vector<Eigen::Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points) box.extend(point);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

double VolumeOf(const TriangleMesh& mesh) {
  double six = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto corner = [&](int i) { return mesh.vertices[static_cast<std::size_t>(t[i])]; };
    six += corner(0).dot(corner(1).cross(corner(2)));
  }
  return six / 6;
}

TriangleMesh FullHull(const std::vector<Eigen::Vector3d>& points) {
  std::vector<double> numbers;
  numbers.reserve(3 * points.size());
  for (const Eigen::Vector3d& point : points)
    numbers.insert(numbers.end(), point.data(), point.data() + 3);
  btConvexHullComputer computer;
  computer.compute(numbers.data(), 3 * sizeof(double), static_cast<int>(points.size()), 0, 0);
  TriangleMesh hull;
  for (int i = 0; i < computer.vertices.size(); ++i) {
    const btVector3& v = computer.vertices[i];
    hull.vertices.emplace_back(v.x(), v.y(), v.z());
  }
  for (int i = 0; i < computer.faces.size(); ++i) {
    const btConvexHullComputer::Edge* first = &computer.edges[computer.faces[i]];
    const btConvexHullComputer::Edge* edge = first->getNextEdgeOfFace();
    for (; edge->getTargetVertex() != first->getSourceVertex(); edge = edge->getNextEdgeOfFace())
      hull.triangles.emplace_back(first->getSourceVertex(), edge->getSourceVertex(),
                                  edge->getTargetVertex());
  }
  if (VolumeOf(hull) < 0) {
    for (Eigen::Vector3i& triangle : hull.triangles) std::swap(triangle[1], triangle[2]);
  }
  return hull;
}

// Farthest points in the directions of a Fibonacci lattice.
std::vector<Eigen::Vector3d> Farthest(const std::vector<Eigen::Vector3d>& points,
                                      std::size_t directions) {
  std::set<std::size_t> kept;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (std::size_t i = 0; i < directions; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(directions);
    const double radius = std::sqrt(1 - z * z);
    const double angle = golden * static_cast<double>(i);
    const Eigen::Vector3d direction(radius * std::cos(angle), radius * std::sin(angle), z);
    const auto farthest = std::max_element(
        points.begin(), points.end(),
        [&](const auto& a, const auto& b) { return direction.dot(a) < direction.dot(b); });
    kept.insert(static_cast<std::size_t>(farthest - points.begin()));
  }
  std::vector<Eigen::Vector3d> result;
  for (const std::size_t index : kept) result.push_back(points[index]);
  return result;
}

}  // namespace

bool IsConvex(const TriangleMesh& mesh) {
  const double hair = 1e-6 * SizeOf(mesh.vertices);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d normal = (mesh.vertices[static_cast<std::size_t>(t[1])] - a)
                                       .cross(mesh.vertices[static_cast<std::size_t>(t[2])] - a);
    const double length = normal.norm();
    for (const Eigen::Vector3d& vertex : mesh.vertices) {
      if (normal.dot(vertex - a) > hair * length) return false;
    }
  }
  return !mesh.triangles.empty();
}

TriangleMesh ConvexHullOf(const std::vector<Eigen::Vector3d>& points, std::size_t most_corners) {
  const double size = SizeOf(points);
  if (points.size() < 4 || size == 0) return {};
  TriangleMesh hull = FullHull(points);
  if (hull.vertices.size() > most_corners) hull = FullHull(Farthest(hull.vertices, most_corners));
  if (VolumeOf(hull) < 1e-9 * size * size * size) return {};
  return hull;
}

}  // namespace doorforge::internal
