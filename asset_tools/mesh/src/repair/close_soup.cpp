// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>

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
#include <boost/iterator/function_output_iterator.hpp>

#include "doorforge/core/error.h"
#include "doorforge/mesh/work_budget.h"

#include "measure/triangle_tree.h"
#include "repair/hole_kernel.h"
#include "repair/surface_mesh.h"
#include "repair/surface_operations.h"

namespace doorforge {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

constexpr std::size_t kMaxCrossings = 20'000'000;  // pairs of triangles; bounds the memory

// Filling a hole takes time that grows with the third power of its border.
struct FillWithinBudget : pmp::Hole_filling::Default_visitor {
  void quadratic_step() const { CheckWork(100); }
  void cubic_step() const { CheckWork(100); }
};

// The kernel, but for a test of two triangles that a hopeless mesh can be given up in.
struct KernelWithinBudget : Kernel {
  struct Do_intersect_3 : Kernel::Do_intersect_3 {
    template <class A, class B>
    bool operator()(const A& a, const B& b) const {
      CheckWork(20);
      return Kernel::Do_intersect_3::operator()(a, b);
    }
  };
  Do_intersect_3 do_intersect_3_object() const { return {}; }
};

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

// Whether a point of the triangle lies farther than `limit_m` from the tree; finds those that lie a
// tenth farther.
bool ReachesBeyond(const std::array<Eigen::Vector3d, 3>& corners, const TriangleTree& tree,
                   double limit_m) {
  const Eigen::Vector3d center = (corners[0] + corners[1] + corners[2]) / 3;
  double radius = 0;
  for (const Eigen::Vector3d& corner : corners) radius = std::max(radius, (corner - center).norm());
  const double distance = tree.Distance(center);
  if (distance > limit_m) return true;
  if (distance + radius <= 1.1 * limit_m) return false;
  std::array<Eigen::Vector3d, 3> middles;
  for (std::size_t k = 0; k < 3; ++k) middles[k] = (corners[k] + corners[(k + 1) % 3]) / 2;
  for (std::size_t k = 0; k < 3; ++k) {
    if (ReachesBeyond({corners[k], middles[k], middles[(k + 2) % 3]}, tree, limit_m)) return true;
  }
  return ReachesBeyond(middles, tree, limit_m);
}

bool IsFar(const SurfaceMesh& surface, const std::vector<SurfaceMesh::Face_index>& cap,
           const TriangleTree& tree, double limit_m) {
  return std::any_of(cap.begin(), cap.end(), [&](SurfaceMesh::Face_index face) {
    std::array<Eigen::Vector3d, 3> corners;
    std::size_t k = 0;
    for (const auto vertex : CGAL::vertices_around_face(surface.halfedge(face), surface)) {
      const Point& p = surface.point(vertex);
      corners[k++] = {p.x(), p.y(), p.z()};
    }
    return ReachesBeyond(corners, tree, limit_m);
  });
}

void FillHoles(SurfaceMesh& surface, const HoleLimits& limits, const TriangleTree& tree,
               ClosedSoup& counts) {
  auto piece_of = surface.add_property_map<SurfaceMesh::Face_index, std::size_t>("f:piece").first;
  std::vector<double> area_of(pmp::connected_components(surface, piece_of), 0.0);
  for (const SurfaceMesh::Face_index face : surface.faces())
    area_of[piece_of[face]] += pmp::face_area(face, surface);
  std::vector<SurfaceMesh::Halfedge_index> borders;
  pmp::extract_boundary_cycles(surface, std::back_inserter(borders));
  for (const SurfaceMesh::Halfedge_index border : borders) {
    const std::vector<Eigen::Vector3d> corners = BorderOf(surface, border);
    const double area = area_of[piece_of[surface.face(surface.opposite(border))]];
    const bool flat = IsSmall(corners, limits.max_flat_size_m) &&
                      FlatArea(corners, limits.flatness_m) <= limits.max_flat_area_share * area;
    if (!flat && !IsSmall(corners, limits.max_size_m)) continue;
    std::vector<SurfaceMesh::Face_index> faces;
    pmp::triangulate_hole(surface, border, std::back_inserter(faces),
                          CGAL::parameters::visitor(FillWithinBudget()).geom_traits(HoleKernel()));
    if (!IsFar(surface, faces, tree, limits.max_cap_distance_m)) {
      counts.holes_filled += !faces.empty();
      continue;
    }
    ++counts.far_caps;
    for (const SurfaceMesh::Face_index face : faces)
      CGAL::Euler::remove_face(surface.halfedge(face), surface);
  }
}

}  // namespace

ClosedSoup CloseSoup(const TriangleMesh& soup, const HoleLimits& holes,
                     const TriangleMesh& around) {
  ClosedSoup closed;
  const TriangleMesh distinct = WithoutRepeats(soup, closed);
  std::vector<Point> points = PointsOf(distinct);
  Polygons polygons = PolygonsOf(distinct);
  pmp::repair_polygon_soup(points, polygons);
  CheckWork();
  const std::size_t before = points.size();
  pmp::orient_polygon_soup(points, polygons);
  CheckWork();
  closed.split_vertices = static_cast<int>(points.size() - before);
  SurfaceMesh surface;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, surface);
  pmp::stitch_borders(surface);
  CheckWork();
  closed.split_vertices += static_cast<int>(pmp::duplicate_non_manifold_vertices(surface));
  FillHoles(surface, holes, TriangleTree(around), closed);
  surface.collect_garbage();
  closed.mesh = TrianglesOf(surface);
  return closed;
}

std::vector<std::pair<int, int>> CrossingTriangles(const TriangleMesh& mesh) {
  const SurfaceMesh surface = SurfaceOf(mesh);
  std::vector<std::pair<int, int>> pairs;
  const auto add = [&](const std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>& faces) {
    if (pairs.size() >= kMaxCrossings)
      throw Error(ErrorCode::kFormat, "more than the " + std::to_string(kMaxCrossings) +
                                          " pairs of triangles that may cross each other");
    const auto s = static_cast<int>(faces.first.idx());
    const auto t = static_cast<int>(faces.second.idx());
    pairs.emplace_back(std::min(s, t), std::max(s, t));
  };
  pmp::self_intersections(surface, boost::make_function_output_iterator(add),
                          CGAL::parameters::geom_traits(KernelWithinBudget()));
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

bool SelfIntersects(const TriangleMesh& mesh) {
  return pmp::does_self_intersect(SurfaceOf(mesh),
                                  CGAL::parameters::geom_traits(KernelWithinBudget()));
}

}  // namespace doorforge
