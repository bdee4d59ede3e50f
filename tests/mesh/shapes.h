// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Core>

#include "doorforge/core/triangle_mesh.h"

// Meshes with known properties.

namespace doorforge {

inline TriangleMesh Box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1 ? high : low).x(), (i & 2 ? high : low).y(),
                               (i & 4 ? high : low).z());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline TriangleMesh UnitBox() { return Box(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()); }

/// A closed surface without an inside: a square and its underside, cut along different diagonals.
inline TriangleMesh FlatPillow() {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
          {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
}

inline TriangleMesh Together(TriangleMesh mesh, const TriangleMesh& more) {
  const int offset = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const Eigen::Vector3i& t : more.triangles)
    mesh.triangles.push_back(t + Eigen::Vector3i::Constant(offset));
  return mesh;
}

inline TriangleMesh InsideOut(TriangleMesh mesh) {
  for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[0], t[1]);
  return mesh;
}

/// Every triangle with corners of its own, as an STL file has them.
inline TriangleMesh Unwelded(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const int first = static_cast<int>(soup.vertices.size());
    for (const int index : t)
      soup.vertices.push_back(mesh.vertices[static_cast<std::size_t>(index)]);
    soup.triangles.emplace_back(first, first + 1, first + 2);
  }
  return soup;
}

/// Torus around z; volume 2 pi^2 R r^2 in the limit.
inline TriangleMesh Torus(double big, double small, int around, int across) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * i / around;
      const double b = 2 * std::numbers::pi * j / across;
      const double radius = big + small * std::cos(b);
      mesh.vertices.emplace_back(radius * std::cos(a), radius * std::sin(a), small * std::sin(b));
      const int next_i = (i + 1) % around * across;
      const int next_j = (j + 1) % across;
      mesh.triangles.emplace_back(i * across + j, next_i + j, next_i + next_j);
      mesh.triangles.emplace_back(i * across + j, next_i + next_j, i * across + next_j);
    }
  }
  return mesh;
}

/// A door frame: the rectangle [0, w] x [0, h] in x and z without the opening at `rim` from its
/// edges, extruded over y in [0, depth]. One closed piece.
inline TriangleMesh RectangularRing(double w, double h, double rim, double depth) {
  TriangleMesh mesh;
  for (const double y : {0.0, depth}) {
    for (const double in : {0.0, rim}) {
      mesh.vertices.emplace_back(in, y, in);
      mesh.vertices.emplace_back(w - in, y, in);
      mesh.vertices.emplace_back(w - in, y, h - in);
      mesh.vertices.emplace_back(in, y, h - in);
    }
  }
  const auto quad = [&](int a, int b, int c, int d) {
    mesh.triangles.emplace_back(a, b, c);
    mesh.triangles.emplace_back(a, c, d);
  };
  for (int k = 0; k < 4; ++k) {
    const int n = (k + 1) % 4;
    quad(k, n, 4 + n, 4 + k);            // front, y = 0
    quad(8 + k, 12 + k, 12 + n, 8 + n);  // back
    quad(k, 8 + k, 8 + n, n);            // outside
    quad(4 + k, 4 + n, 12 + n, 12 + k);  // around the opening
  }
  return mesh;
}

}  // namespace doorforge
