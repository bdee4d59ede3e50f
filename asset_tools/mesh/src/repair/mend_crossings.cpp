// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <exception>

#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/error.h"
#include "doorforge/mesh/work_budget.h"

#include "repair/hole_kernel.h"
#include "repair/surface_mesh.h"
#include "repair/surface_operations.h"

namespace doorforge {
namespace {

// Gives up what takes longer than other ways to do without crossings.
class WithinPatience {
 public:
  bool stop() const { return patches_ > kMostPatches; }
  void start_component_handling() {
    ++patches_;
    CheckWork(kSteps);
  }
  template <class Faces>
  void status_update(const Faces&) {}
  void start_main_loop() {}
  void end_main_loop() {}
  void start_iteration() {}
  void end_iteration() {}
  void end_component_handling() {}
  void parameters_used(bool, bool, int, double, double, double) {}

 private:
  static constexpr int kMostPatches = 30;
  static constexpr unsigned kSteps = 10'000;

  int patches_ = 0;
};

}  // namespace

std::optional<TriangleMesh> WithCrossingsMended(const TriangleMesh& mesh) {
  constexpr unsigned kRounds = 3;  // what is not mended by then seldom is
  constexpr std::size_t kMostPairs = 50;
  constexpr std::size_t kMostWork =
      250'000;  // pairs times triangles: seconds, where a wrap is quicker
  const std::size_t pairs = CrossingTriangles(mesh).size();
  if (pairs > kMostPairs || pairs * mesh.triangles.size() > kMostWork) return std::nullopt;
  SurfaceMesh surface = SurfaceOf(mesh);
  try {
    CGAL::Polygon_mesh_processing::experimental::remove_self_intersections(
        surface, CGAL::parameters::number_of_iterations(kRounds)
                     .visitor(WithinPatience())
                     .geom_traits(HoleKernel()));
  } catch (const Error&) {
    throw;  // the budget is used up
  } catch (const std::exception&) {
    return std::nullopt;
  }
  surface.collect_garbage();
  TriangleMesh mended = TrianglesOf(surface);
  if (!ClosedMesh::From(mended) || SelfIntersects(mended)) return std::nullopt;
  return mended;
}

}  // namespace doorforge
