// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include "doorforge/core/triangle_mesh.h"

#include "repair/exact_orientation.h"

// Only for the sources named in surface_operations.h.

namespace doorforge {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Polygons = std::vector<std::vector<std::size_t>>;

inline std::vector<Point> PointsOf(const TriangleMesh& mesh) {
  std::vector<Point> points;
  points.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  return points;
}

inline Polygons PolygonsOf(const TriangleMesh& mesh) {
  Polygons polygons;
  polygons.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& t : mesh.triangles)
    polygons.push_back({static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                        static_cast<std::size_t>(t[2])});
  return polygons;
}

/// Without the vertices that no triangle uses.
inline TriangleMesh TrianglesOf(const SurfaceMesh& surface) {
  TriangleMesh mesh;
  std::vector<int> index(surface.num_vertices(), -1);
  for (const SurfaceMesh::Face_index face : surface.faces()) {
    Eigen::Vector3i triangle;
    int corner = 0;
    for (const SurfaceMesh::Vertex_index v : surface.vertices_around_face(surface.halfedge(face))) {
      int& at = index[static_cast<std::size_t>(v)];
      if (at < 0) {
        at = static_cast<int>(mesh.vertices.size());
        const Point& p = surface.point(v);
        mesh.vertices.emplace_back(p.x(), p.y(), p.z());
      }
      triangle[corner++] = at;
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

/// The mesh must be manifold and consistently oriented.
inline SurfaceMesh SurfaceOf(const TriangleMesh& mesh) {
  SurfaceMesh surface;
  std::vector<SurfaceMesh::Vertex_index> vertices;
  for (const Point& point : PointsOf(mesh)) vertices.push_back(surface.add_vertex(point));
  for (const Eigen::Vector3i& t : mesh.triangles)
    surface.add_face(vertices[static_cast<std::size_t>(t[0])],
                     vertices[static_cast<std::size_t>(t[1])],
                     vertices[static_cast<std::size_t>(t[2])]);
  return surface;
}

}  // namespace doorforge
