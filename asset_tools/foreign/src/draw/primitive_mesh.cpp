// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/primitive_mesh.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace doorforge::foreign {
namespace {

constexpr int kCorners = 32;

/// A circle of a body of revolution about z.
struct Ring {
  double radius_m;
  double z_m;
};

// Rings from below, closed by a point at either end.
TriangleMesh Revolved(const std::vector<Ring>& rings, double bottom_m, double top_m) {
  TriangleMesh mesh;
  for (const Ring& ring : rings) {
    for (int k = 0; k < kCorners; ++k) {
      const double angle = 2 * std::numbers::pi * k / kCorners;
      mesh.vertices.emplace_back(ring.radius_m * std::cos(angle), ring.radius_m * std::sin(angle),
                                 ring.z_m);
    }
  }
  const auto bottom = static_cast<int>(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 0, bottom_m);
  mesh.vertices.emplace_back(0, 0, top_m);
  const int last = kCorners * (static_cast<int>(rings.size()) - 1);
  for (int k = 0; k < kCorners; ++k) {
    const int next = (k + 1) % kCorners;
    mesh.triangles.emplace_back(bottom, next, k);
    for (int at = 0; at < last; at += kCorners) {
      mesh.triangles.emplace_back(at + k, at + next, at + kCorners + next);
      mesh.triangles.emplace_back(at + k, at + kCorners + next, at + kCorners + k);
    }
    mesh.triangles.emplace_back(bottom + 1, last + k, last + next);
  }
  return mesh;
}

}  // namespace

TriangleMesh BoxMesh(const Eigen::Vector3d& size_m) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.emplace_back((corner & 1 ? 0.5 : -0.5) * size_m.x(),
                               (corner & 2 ? 0.5 : -0.5) * size_m.y(),
                               (corner & 4 ? 0.5 : -0.5) * size_m.z());
  const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    mesh.triangles.emplace_back(q[0], q[1], q[2]);
    mesh.triangles.emplace_back(q[0], q[2], q[3]);
  }
  return mesh;
}

TriangleMesh CylinderMesh(double radius_m, double length_m) {
  return Revolved({{radius_m, -length_m / 2}, {radius_m, length_m / 2}}, -length_m / 2,
                  length_m / 2);
}

TriangleMesh SphereMesh(double radius_m) {
  constexpr int kRings = 15;
  std::vector<Ring> rings;
  for (int i = 1; i <= kRings; ++i) {
    const double angle = std::numbers::pi * i / (kRings + 1);
    rings.push_back({radius_m * std::sin(angle), -radius_m * std::cos(angle)});
  }
  return Revolved(rings, -radius_m, radius_m);
}

}  // namespace doorforge::foreign
