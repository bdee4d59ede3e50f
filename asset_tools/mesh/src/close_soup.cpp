// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <Eigen/Geometry>

#include "surface_mesh.h"
#include "surface_operations.h"

namespace doorforge {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

// Drops what adds nothing: triangles with a repeated corner and the repeats of others, in either
// winding. Slivers stay, they may hold the surface together.
TriangleMesh WithoutRepeats(const TriangleMesh& soup, ClosedSoup& counts) {
  TriangleMesh kept{soup.vertices, {}};
  std::set<std::array<int, 3>> seen;
  for (const Eigen::Vector3i& t : soup.triangles) {
    std::array<int, 3> corners{t[0], t[1], t[2]};
    std::sort(corners.begin(), corners.end());
    if (corners[0] == corners[1] || corners[1] == corners[2]) {
      ++counts.degenerate_triangles;
    } else if (!seen.insert(corners).second) {
      ++counts.duplicate_triangles;
    } else {
      kept.triangles.push_back(t);
    }
  }
  return kept;
}

std::vector<Eigen::Vector3d> BorderOf(const SurfaceMesh& surface,
                                      SurfaceMesh::Halfedge_index border) {
  std::vector<Eigen::Vector3d> corners;
  for (const SurfaceMesh::Halfedge_index h : CGAL::halfedges_around_face(border, surface)) {
    const Point& p = surface.point(surface.target(h));
    corners.emplace_back(p.x(), p.y(), p.z());
  }
  return corners;
}

bool IsSmall(const std::vector<Eigen::Vector3d>& border, double max_size_m) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& corner : border) box.extend(corner);
  return box.diagonal().norm() <= max_size_m;
}

// Area of a border that lies in a plane; infinite for any other.
double FlatArea(const std::vector<Eigen::Vector3d>& border, double flatness_m) {
  Eigen::Vector3d doubled = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < border.size(); ++i) {
    doubled += (border[i] - border[0]).cross(border[(i + 1) % border.size()] - border[0]);
    mean += border[i] / static_cast<double>(border.size());
  }
  const Eigen::Vector3d normal = doubled.normalized();
  for (const Eigen::Vector3d& corner : border) {
    if (!(std::abs(normal.dot(corner - mean)) <= flatness_m))
      return std::numeric_limits<double>::infinity();
  }
  return 0.5 * doubled.norm();
}

int FillHoles(SurfaceMesh& surface, const HoleLimits& limits) {
  auto piece_of = surface.add_property_map<SurfaceMesh::Face_index, std::size_t>("f:piece").first;
  std::vector<double> area_of(pmp::connected_components(surface, piece_of), 0.0);
  for (const SurfaceMesh::Face_index face : surface.faces())
    area_of[piece_of[face]] += pmp::face_area(face, surface);
  std::vector<SurfaceMesh::Halfedge_index> borders;
  pmp::extract_boundary_cycles(surface, std::back_inserter(borders));
  int filled = 0;
  for (const SurfaceMesh::Halfedge_index border : borders) {
    const std::vector<Eigen::Vector3d> corners = BorderOf(surface, border);
    const double area = area_of[piece_of[surface.face(surface.opposite(border))]];
    const bool flat = IsSmall(corners, limits.max_flat_size_m) &&
                      FlatArea(corners, limits.flatness_m) <= limits.max_flat_area_share * area;
    if (!flat && !IsSmall(corners, limits.max_size_m)) continue;
    std::vector<SurfaceMesh::Face_index> faces;
    pmp::triangulate_hole(surface, border, std::back_inserter(faces));
    filled += !faces.empty();
  }
  return filled;
}

}  // namespace

ClosedSoup CloseSoup(const TriangleMesh& soup, const HoleLimits& holes) {
  ClosedSoup closed;
  const TriangleMesh distinct = WithoutRepeats(soup, closed);
  std::vector<Point> points = PointsOf(distinct);
  Polygons polygons = PolygonsOf(distinct);
  pmp::repair_polygon_soup(points, polygons);
  const std::size_t before = points.size();
  pmp::orient_polygon_soup(points, polygons);
  closed.split_vertices = static_cast<int>(points.size() - before);
  SurfaceMesh surface;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, surface);
  pmp::stitch_borders(surface);
  closed.split_vertices += static_cast<int>(pmp::duplicate_non_manifold_vertices(surface));
  closed.holes_filled = FillHoles(surface, holes);
  surface.collect_garbage();
  closed.mesh = TrianglesOf(surface);
  return closed;
}

std::vector<std::pair<int, int>> CrossingTriangles(const TriangleMesh& mesh) {
  const SurfaceMesh surface = SurfaceOf(mesh);
  std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> faces;
  pmp::self_intersections(surface, std::back_inserter(faces));
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [a, b] : faces) {
    const auto s = static_cast<int>(a.idx());
    const auto t = static_cast<int>(b.idx());
    pairs.emplace_back(std::min(s, t), std::max(s, t));
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

bool SelfIntersects(const TriangleMesh& mesh) { return pmp::does_self_intersect(SurfaceOf(mesh)); }

}  // namespace doorforge
