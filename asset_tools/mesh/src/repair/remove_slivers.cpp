// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "doorforge/mesh/work_budget.h"

#include "repair/surface_mesh.h"
#include "repair/surface_operations.h"

namespace doorforge {
namespace {

namespace sms = CGAL::Surface_mesh_simplification;

// Stops at the first collapse that costs more.
class Affordable {
 public:
  explicit Affordable(double max_cost) : max_cost_(max_cost) {}

  template <class Cost, class Profile>
  bool operator()(const Cost& cost, const Profile&, std::size_t, std::size_t) const {
    CheckWork(200);
    return cost > max_cost_;
  }

 private:
  double max_cost_;
};

}  // namespace

// The cost is a sum of squared distances.
TriangleMesh WithoutSlivers(const TriangleMesh& mesh, double free_error_m) {
  SurfaceMesh surface = SurfaceOf(mesh);
  const sms::GarlandHeckbert_plane_policies<SurfaceMesh, Kernel> policies(surface);
  sms::edge_collapse(surface, Affordable(free_error_m * free_error_m),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .filter(sms::Bounded_normal_change_filter<>()));
  surface.collect_garbage();
  return TrianglesOf(surface);
}

}  // namespace doorforge
