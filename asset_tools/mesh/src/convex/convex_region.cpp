// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "convex/convex_region.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "doorforge/core/error.h"
#include "doorforge/mesh/work_budget.h"

#include "convex/growing_hull.h"

namespace doorforge {
namespace {

// How far a point lies outside of the half-spaces' intersection; negative inside.
double Outside(const std::vector<HalfSpace>& faces, const Eigen::Vector3d& point) {
  double outside = -1e300;
  for (const HalfSpace& face : faces)
    outside = std::max(outside, face.normal.dot(point) - face.offset);
  return outside;
}

// Extreme vertices along the axes and the diagonals of a cube: a tetrahedron at least.
std::vector<Eigen::Vector3d> Extremes(const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<Eigen::Vector3d> chosen;
  for (int code = 0; code < 27; ++code) {
    const Eigen::Vector3d direction =
        Eigen::Vector3i(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1).cast<double>();
    if (direction.isZero()) continue;
    const auto farthest = std::max_element(vertices.begin(), vertices.end(),
                                           [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
                                             return a.dot(direction) < b.dot(direction);
                                           });
    if (std::find(chosen.begin(), chosen.end(), *farthest) == chosen.end())
      chosen.push_back(*farthest);
  }
  return chosen;
}

}  // namespace

std::vector<HalfSpace> HalfSpacesOf(const TriangleMesh& hull) {
  std::vector<HalfSpace> faces;
  for (const Eigen::Vector3i& t : hull.triangles) {
    const Eigen::Vector3d& a = hull.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d& b = hull.vertices[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d& c = hull.vertices[static_cast<std::size_t>(t[2])];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const double length = normal.norm();
    // the height over the longest side says whether the normal means anything
    const double longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
    if (!(length > 1e-9 * longest * longest)) continue;
    const Eigen::Vector3d unit = normal / length;
    faces.push_back({unit, std::max({unit.dot(a), unit.dot(b), unit.dot(c)})});
  }
  return faces;
}

std::optional<TriangleMesh> HullOf(std::span<const Eigen::Vector3d> points) {
  return GrownHull(points, 0);
}

TriangleMesh ReducedHull(const TriangleMesh& hull, int max_vertices) {
  const auto limit = static_cast<std::size_t>(max_vertices);
  if (hull.vertices.size() <= limit) return hull;
  std::vector<Eigen::Vector3d> chosen = Extremes(hull.vertices);
  if (chosen.size() > limit) chosen.resize(limit);
  std::optional<TriangleMesh> reduced = HullOf(chosen);
  while (chosen.size() < limit) {
    const std::vector<HalfSpace> faces =
        reduced ? HalfSpacesOf(*reduced) : std::vector<HalfSpace>{};
    double farthest = 0;
    const Eigen::Vector3d* next = nullptr;
    for (const Eigen::Vector3d& vertex : hull.vertices) {
      if (!reduced && std::find(chosen.begin(), chosen.end(), vertex) == chosen.end())
        next = &vertex;
      const double outside = reduced ? Outside(faces, vertex) : 0;
      if (outside <= farthest) continue;
      farthest = outside;
      next = &vertex;
    }
    if (next == nullptr) break;
    chosen.push_back(*next);
    reduced = HullOf(chosen);
  }
  return reduced ? *reduced : hull;
}

double VolumeOf(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  const Eigen::Vector3d origin = mesh.vertices[0];
  double volume = 0;
  for (const Eigen::Vector3i& t : mesh.triangles)
    volume += (mesh.vertices[static_cast<std::size_t>(t[0])] - origin)
                  .dot((mesh.vertices[static_cast<std::size_t>(t[1])] - origin)
                           .cross(mesh.vertices[static_cast<std::size_t>(t[2])] - origin)) /
              6;
  return volume;
}

}  // namespace doorforge
