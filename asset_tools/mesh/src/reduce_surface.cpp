// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/convex_hull_3.h>
#include <CGAL/intersections.h>

#include "doorforge/core/error.h"
#include "doorforge/mesh/convex_parts.h"

#include "mesh_pieces.h"
#include "surface_mesh.h"
#include "surface_operations.h"

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
    return edges <= max_edges_ && cost > max_cost_;
  }

 private:
  std::size_t max_edges_;
  double max_cost_;
};

Point PointAt(const TriangleMesh& mesh, int index) {
  const Eigen::Vector3d& v = mesh.vertices[static_cast<std::size_t>(index)];
  return {v.x(), v.y(), v.z()};
}

// Edges that a collapse must leave alone: those with a kept end.
struct KeptEdges {
  using key_type = SurfaceMesh::Edge_index;
  using value_type = bool;
  using reference = bool;
  using category = boost::readable_property_map_tag;

  const SurfaceMesh* surface = nullptr;
  const std::vector<char>* is_kept = nullptr;  // for each vertex; none where it is empty

  friend bool get(const KeptEdges& kept, SurfaceMesh::Edge_index edge) {
    if (kept.is_kept->empty()) return false;
    return (*kept.is_kept)[kept.surface->vertex(edge, 0)] != 0 ||
           (*kept.is_kept)[kept.surface->vertex(edge, 1)] != 0;
  }
};

// Those of the triangles that meet a box.
std::vector<char> VerticesAround(const std::vector<Eigen::AlignedBox3d>& boxes,
                                 const TriangleMesh& mesh) {
  std::vector<char> is_around;
  if (boxes.empty()) return is_around;
  is_around.resize(mesh.vertices.size(), 0);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Kernel::Triangle_3 triangle(PointAt(mesh, t[0]), PointAt(mesh, t[1]),
                                      PointAt(mesh, t[2]));
    const CGAL::Bbox_3 bounds = triangle.bbox();
    const bool meets = std::any_of(boxes.begin(), boxes.end(), [&](const Eigen::AlignedBox3d& b) {
      const CGAL::Bbox_3 box(b.min().x(), b.min().y(), b.min().z(), b.max().x(), b.max().y(),
                             b.max().z());
      return CGAL::do_overlap(bounds, box) && CGAL::do_intersect(box, triangle);
    });
    if (!meets) continue;
    for (const int corner : t) is_around[static_cast<std::size_t>(corner)] = 1;
  }
  return is_around;
}

// ---- one triangulation for one hull -----------------------------------------------------------

using Edge = std::pair<int, int>;

// For each triangle the first one of its facet: triangles in one plane, joined across edges.
std::vector<std::size_t> FacetOfTriangles(const TriangleMesh& hull) {
  std::map<Edge, std::size_t> triangle_at;
  for (std::size_t i = 0; i < hull.triangles.size(); ++i) {
    const Eigen::Vector3i& t = hull.triangles[i];
    for (int k = 0; k < 3; ++k) triangle_at[{t[k], t[(k + 1) % 3]}] = i;
  }
  std::vector<std::size_t> facet(hull.triangles.size(), hull.triangles.size());
  for (std::size_t first = 0; first < facet.size(); ++first) {
    if (facet[first] != facet.size()) continue;
    facet[first] = first;
    std::vector<std::size_t> pending = {first};
    while (!pending.empty()) {
      const Eigen::Vector3i t = hull.triangles[pending.back()];
      pending.pop_back();
      for (int k = 0; k < 3; ++k) {
        const std::size_t next = triangle_at.at({t[(k + 1) % 3], t[k]});
        if (facet[next] != facet.size()) continue;
        const bool in_plane = [&] {
          const Eigen::Vector3i& other = hull.triangles[next];
          return std::all_of(other.begin(), other.end(), [&](int corner) {
            return CGAL::orientation(PointAt(hull, t[0]), PointAt(hull, t[1]), PointAt(hull, t[2]),
                                     PointAt(hull, corner)) == CGAL::COPLANAR;
          });
        }();
        if (!in_plane) continue;
        facet[next] = first;
        pending.push_back(next);
      }
    }
  }
  return facet;
}

// The convex polygon around each facet, from its smallest vertex, without vertices that lie within
// an edge (where only two facets meet).
std::vector<std::vector<int>> FacetPolygons(const TriangleMesh& hull) {
  const std::vector<std::size_t> facet = FacetOfTriangles(hull);
  std::map<Edge, std::size_t> facet_at;
  std::map<int, std::set<std::size_t>> facets_around;
  for (std::size_t i = 0; i < facet.size(); ++i) {
    const Eigen::Vector3i& t = hull.triangles[i];
    for (int k = 0; k < 3; ++k) {
      facet_at[{t[k], t[(k + 1) % 3]}] = facet[i];
      facets_around[t[k]].insert(facet[i]);
    }
  }
  std::map<std::size_t, std::map<int, int>> next_around;
  for (const auto& [edge, at] : facet_at) {
    if (facet_at.at({edge.second, edge.first}) != at) next_around[at][edge.first] = edge.second;
  }
  std::vector<std::vector<int>> polygons;
  for (const auto& [at, next] : next_around) {
    std::vector<int> polygon;
    int vertex = next.begin()->first;
    do {
      if (facets_around[vertex].size() >= 3) polygon.push_back(vertex);
      vertex = next.at(vertex);
    } while (vertex != next.begin()->first);
    std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
    polygons.push_back(std::move(polygon));
  }
  std::sort(polygons.begin(), polygons.end());
  return polygons;
}

// CGAL orders facets by addresses and cuts those with more than three corners either way, so the
// same points give other triangles each time. The facets themselves are unique: they are cut into
// fans here, in lexicographic order.
TriangleMesh CanonicalHull(const TriangleMesh& hull) {
  const TriangleMesh sorted = InVertexOrder(hull);
  TriangleMesh canonical;
  std::vector<int> new_index(sorted.vertices.size(), -1);
  const std::vector<std::vector<int>> polygons = FacetPolygons(sorted);
  std::set<int> used;
  for (const std::vector<int>& polygon : polygons) used.insert(polygon.begin(), polygon.end());
  for (const int vertex : used) {
    new_index[static_cast<std::size_t>(vertex)] = static_cast<int>(canonical.vertices.size());
    canonical.vertices.push_back(sorted.vertices[static_cast<std::size_t>(vertex)]);
  }
  const auto at = [&](int vertex) { return new_index[static_cast<std::size_t>(vertex)]; };
  for (const std::vector<int>& polygon : polygons) {
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      canonical.triangles.emplace_back(at(polygon[0]), at(polygon[i]), at(polygon[i + 1]));
  }
  return canonical;
}

}  // namespace

TriangleMesh Simplified(const TriangleMesh& mesh, int max_triangles, double free_error_m,
                        const std::vector<Eigen::AlignedBox3d>& kept) {
  SurfaceMesh surface = SurfaceOf(mesh);
  // a closed surface has three edges for two triangles; the cost is a sum of squared distances
  const BudgetAndCost stop(static_cast<std::size_t>(max_triangles) * 3 / 2,
                           free_error_m * free_error_m);
  const sms::GarlandHeckbert_plane_policies<SurfaceMesh, Kernel> policies(surface);
  const sms::Bounded_normal_change_filter<> filter;
  const std::vector<char> is_kept = VerticesAround(kept, mesh);
  sms::edge_collapse(surface, stop,
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .filter(filter)
                         .edge_is_constrained_map(KeptEdges{&surface, &is_kept}));
  surface.collect_garbage();
  return TrianglesOf(surface);
}

TriangleMesh ConvexHull(std::span<const Eigen::Vector3d> points) {
  std::vector<Point> cloud;
  for (const Eigen::Vector3d& p : points) {
    Require(p.allFinite(), ErrorCode::kInvalidArgument, "a point of a convex hull is not finite");
    cloud.emplace_back(p.x(), p.y(), p.z());
  }
  SurfaceMesh surface;
  if (cloud.size() >= 4) CGAL::convex_hull_3(cloud.begin(), cloud.end(), surface);
  TriangleMesh hull = TrianglesOf(surface);
  Require(ClosedMesh::From(hull).has_value(), ErrorCode::kInvalidArgument,
          "the points of a convex hull lie in one plane");
  return CanonicalHull(hull);
}

}  // namespace doorforge
