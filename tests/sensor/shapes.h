// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include "doorforge/core/rng.h"
#include "doorforge/core/triangle_mesh.h"
#include "doorforge/sensor/scene_geometry.h"

namespace doorforge::shapes {

/// Axis-parallel box.
inline TriangleMesh Box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                               (i & 4) != 0 ? high.z() : low.z());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// Two triangles in the plane x = `x`, |y|, |z - 1.5| <= half.
inline TriangleMesh Wall(double x, double half) {
  TriangleMesh mesh;
  mesh.vertices = {
      {x, -half, 1.5 - half}, {x, half, 1.5 - half}, {x, half, 1.5 + half}, {x, -half, 1.5 + half}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// Small triangles at random places in the unit cube around the origin.
inline TriangleMesh Soup(int count, std::uint64_t seed) {
  TriangleMesh mesh;
  Rng rng(seed, "soup");
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d center(rng.Uniform(-0.5, 0.5), rng.Uniform(-0.5, 0.5),
                                 rng.Uniform(-0.5, 0.5));
    for (int corner = 0; corner < 3; ++corner)
      mesh.vertices.push_back(center +
                              0.15 * Eigen::Vector3d(rng.Normal(), rng.Normal(), rng.Normal()));
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return mesh;
}

/// Ray parameter of the nearest hit, by testing every triangle (Moeller and Trumbore, 1997).
inline double NearestHit(const TriangleMesh& mesh, const Eigen::Vector3d& origin,
                         const Eigen::Vector3d& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[static_cast<std::size_t>(triangle[0])];
    const Eigen::Vector3d ab = mesh.vertices[static_cast<std::size_t>(triangle[1])] - a;
    const Eigen::Vector3d ac = mesh.vertices[static_cast<std::size_t>(triangle[2])] - a;
    const Eigen::Vector3d p = direction.cross(ac);
    const double determinant = ab.dot(p);
    if (determinant == 0) continue;
    const Eigen::Vector3d s = origin - a;
    const double u = s.dot(p) / determinant;
    const double v = direction.dot(s.cross(ab)) / determinant;
    const double t = ac.dot(s.cross(ab)) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t < nearest) nearest = t;
  }
  return nearest;
}

}  // namespace doorforge::shapes
