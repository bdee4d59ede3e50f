// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/convex_hull_3.h>

#include "doorforge/core/error.h"
#include "doorforge/mesh/convex_parts.h"

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

}  // namespace

TriangleMesh Simplified(const TriangleMesh& mesh, int max_triangles, double free_error_m) {
  SurfaceMesh surface = SurfaceOf(mesh);
  // a closed surface has three edges for two triangles; the cost is a sum of squared distances
  const BudgetAndCost stop(static_cast<std::size_t>(max_triangles) * 3 / 2,
                           free_error_m * free_error_m);
  const sms::GarlandHeckbert_plane_policies<SurfaceMesh, Kernel> policies(surface);
  const sms::Bounded_normal_change_filter<> filter;
  sms::edge_collapse(surface, stop,
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .filter(filter));
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
  return hull;
}

}  // namespace doorforge
