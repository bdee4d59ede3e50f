// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <CGAL/Surface_mesh_simplification/Edge_collapse_visitor_base.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/intersections.h>

#include "doorforge/core/error.h"
#include "doorforge/mesh/work_budget.h"

#include "measure/mesh_pieces.h"
#include "repair/box_octree.h"
#include "repair/surface_mesh.h"
#include "repair/surface_operations.h"

namespace doorforge {

namespace {

namespace sms = CGAL::Surface_mesh_simplification;

// Stops within the budget, and there only at the first collapse that costs something: flat regions
// end up with the few triangles they need.
class BudgetAndCost {
 public:
  BudgetAndCost(std::size_t max_edges, double max_cost)
      : max_edges_(max_edges), max_cost_(max_cost) {}

  template <class Cost, class Profile>
  bool operator()(const Cost& cost, const Profile&, std::size_t, std::size_t edges) const {
    CheckWork(200);
    return edges <= max_edges_ && cost > max_cost_;
  }

 private:
  std::size_t max_edges_;
  double max_cost_;
};

// ---- collapses after which no triangles cross -------------------------------------------------

// The triangles as they are while edges collapse, to be found by place.
struct PlacedTriangles {
  using Face = SurfaceMesh::Face_index;
  using Vertex = SurfaceMesh::Vertex_index;

  explicit PlacedTriangles(const SurfaceMesh& mesh)
      : surface(&mesh), boxes(BoxAround(mesh), mesh.number_of_faces()) {
    for (const Face face : mesh.faces()) Put(face);
  }

  static Eigen::AlignedBox3d BoxAround(const SurfaceMesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const Vertex v : mesh.vertices()) box.extend(VectorOf(mesh.point(v)));
    return box;
  }

  static Eigen::Vector3d VectorOf(const Point& point) { return {point.x(), point.y(), point.z()}; }

  std::array<Vertex, 3> CornersOf(Face face) const {
    const auto h = surface->halfedge(face);
    return {surface->source(h), surface->target(h), surface->target(surface->next(h))};
  }

  void Put(Face face) {
    Eigen::AlignedBox3d box;
    for (const Vertex v : CornersOf(face)) box.extend(VectorOf(surface->point(v)));
    boxes.Put(static_cast<std::size_t>(face), box);
  }

  const SurfaceMesh* surface;
  BoxOctree boxes;
};

struct CornerTriangle {
  std::array<SurfaceMesh::Vertex_index, 3> corners;
  std::array<Point, 3> points;
};

// Whether the triangles share more than their common corners and edge.
bool Cross(const CornerTriangle& s, const CornerTriangle& t) {
  std::array<int, 3> common_s{}, common_t{};  // the places of common corners
  int common = 0;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (s.corners[i] != t.corners[k]) continue;
      common_s[common] = i;
      common_t[common++] = k;
    }
  }
  const Kernel::Triangle_3 triangle_s(s.points[0], s.points[1], s.points[2]);
  const Kernel::Triangle_3 triangle_t(t.points[0], t.points[1], t.points[2]);
  if (common == 0) return CGAL::do_intersect(triangle_s, triangle_t);
  if (common == 1) {
    const auto opposite = [](const CornerTriangle& of, int corner) {
      return Kernel::Segment_3(of.points[(corner + 1) % 3], of.points[(corner + 2) % 3]);
    };
    return CGAL::do_intersect(triangle_s, opposite(t, common_t[0])) ||
           CGAL::do_intersect(triangle_t, opposite(s, common_s[0]));
  }
  if (common == 3) return true;
  const Point& a = s.points[common_s[0]];
  const Point& b = s.points[common_s[1]];
  const Point& c = s.points[3 - common_s[0] - common_s[1]];
  const Point& d = t.points[3 - common_t[0] - common_t[1]];
  return CGAL::orientation(a, b, c, d) == CGAL::COPLANAR &&
         CGAL::coplanar_orientation(a, b, c, d) == CGAL::POSITIVE;  // folded over
}

// Refuses a collapse that turns a triangle over, flattens one to a line or makes two cross.
class WithoutCrossings {
 public:
  explicit WithoutCrossings(const PlacedTriangles& triangles) : triangles_(&triangles) {}

  template <class Profile>
  boost::optional<Point> operator()(const Profile& profile, boost::optional<Point> to) const {
    to = normals_(profile, to);
    if (to && !IsFree(profile.v0(), profile.v1(), *to)) to = boost::none;
    return to;
  }

 private:
  using Face = PlacedTriangles::Face;
  using Vertex = PlacedTriangles::Vertex;

  // A triangle as it will be.
  struct Placed {
    CornerTriangle triangle;
    Eigen::AlignedBox3d box;
  };

  // The edge's ends become one corner, `kept`, at `to`.
  bool IsFree(Vertex kept, Vertex gone, const Point& to) const {
    const std::vector<Placed> moved = MovedBy(kept, gone, to);
    Eigen::AlignedBox3d reach;
    for (const Placed& one : moved) {
      CheckWork(100);
      const std::array<Point, 3>& points = one.triangle.points;
      if (CGAL::collinear(points[0], points[1], points[2])) return false;
      reach.extend(one.box);
    }
    for (std::size_t i = 0; i < moved.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (Cross(moved[i].triangle, moved[k].triangle)) return false;
      }
    }
    return std::none_of(
        moved.begin(), moved.end(), [&, still = StillIn(reach, kept, gone)](const Placed& one) {
          return std::any_of(still.begin(), still.end(), [&](const Placed& other) {
            return one.box.intersects(other.box) && Cross(one.triangle, other.triangle);
          });
        });
  }

  // The triangles of one end or the other; those of both vanish.
  std::vector<Placed> MovedBy(Vertex kept, Vertex gone, const Point& to) const {
    const SurfaceMesh& surface = *triangles_->surface;
    std::vector<Placed> moved;
    for (const Vertex end : {kept, gone}) {
      for (const Face face : surface.faces_around_target(surface.halfedge(end))) {
        Placed placed = AsItIs(face);
        if (EndsAmong(placed.triangle, kept, gone) == 2) continue;
        placed.box.setEmpty();
        for (std::size_t i = 0; i < 3; ++i) {
          Vertex& corner = placed.triangle.corners[i];
          if (corner == end) placed.triangle.points[i] = to, corner = kept;
          placed.box.extend(PlacedTriangles::VectorOf(placed.triangle.points[i]));
        }
        moved.push_back(placed);
      }
    }
    return moved;
  }

  // What touches the box and stays where it is.
  std::vector<Placed> StillIn(const Eigen::AlignedBox3d& box, Vertex kept, Vertex gone) const {
    std::vector<std::size_t> near;
    triangles_->boxes.Find(box, near);
    std::vector<Placed> still;
    for (const std::size_t index : near) {
      const Placed placed = AsItIs(Face(static_cast<Face::size_type>(index)));
      if (EndsAmong(placed.triangle, kept, gone) == 0) still.push_back(placed);
    }
    return still;
  }

  Placed AsItIs(Face face) const {
    Placed placed{{triangles_->CornersOf(face), {}}, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      placed.triangle.points[i] = triangles_->surface->point(placed.triangle.corners[i]);
      placed.box.extend(PlacedTriangles::VectorOf(placed.triangle.points[i]));
    }
    return placed;
  }

  static std::ptrdiff_t EndsAmong(const CornerTriangle& triangle, Vertex kept, Vertex gone) {
    return std::count(triangle.corners.begin(), triangle.corners.end(), kept) +
           std::count(triangle.corners.begin(), triangle.corners.end(), gone);
  }

  const PlacedTriangles* triangles_;
  sms::Bounded_normal_change_filter<> normals_;
};

// Keeps the triangles' places up to date.
struct PlacesAfterCollapse : sms::Edge_collapse_visitor_base<SurfaceMesh> {
  explicit PlacesAfterCollapse(PlacedTriangles& triangles) : places(&triangles) {}

  void OnCollapsing(const Profile& profile, boost::optional<Point>) {
    for (const auto h : {profile.v0_v1(), profile.v1_v0()}) {
      const PlacedTriangles::Face face = places->surface->face(h);
      if (face != SurfaceMesh::null_face()) places->boxes.Remove(static_cast<std::size_t>(face));
    }
  }
  void OnCollapsed(const Profile&, SurfaceMesh::Vertex_index vertex) {
    const SurfaceMesh& surface = *places->surface;
    for (const auto face : surface.faces_around_target(surface.halfedge(vertex))) places->Put(face);
  }

  PlacedTriangles* places;
};

template <class Filter, class Visitor>
TriangleMesh Collapsed(SurfaceMesh& surface, const BudgetAndCost& stop, const Filter& filter,
                       const Visitor& visitor) {
  const sms::GarlandHeckbert_plane_policies<SurfaceMesh, Kernel> policies(surface);
  sms::edge_collapse(surface, stop,
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .filter(filter)
                         .visitor(visitor));
  surface.collect_garbage();
  return TrianglesOf(surface);
}

// A closed surface has three edges for two triangles; the cost is a sum of squared distances.
BudgetAndCost StopAt(int max_triangles, double free_error_m) {
  return {static_cast<std::size_t>(max_triangles) * 3 / 2, free_error_m * free_error_m};
}

}  // namespace

TriangleMesh Simplified(const TriangleMesh& mesh, int max_triangles, double free_error_m) {
  SurfaceMesh surface = SurfaceOf(mesh);
  return Collapsed(surface, StopAt(max_triangles, free_error_m),
                   sms::Bounded_normal_change_filter<>(),
                   sms::Edge_collapse_visitor_base<SurfaceMesh>());
}

TriangleMesh SimplifiedWithoutCrossings(const TriangleMesh& mesh, int max_triangles,
                                        double free_error_m) {
  SurfaceMesh surface = SurfaceOf(mesh);
  PlacedTriangles places(surface);
  return Collapsed(surface, StopAt(max_triangles, free_error_m), WithoutCrossings(places),
                   PlacesAfterCollapse(places));
}

}  // namespace doorforge
