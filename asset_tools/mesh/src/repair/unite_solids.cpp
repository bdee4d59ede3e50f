// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <string>
#include <utility>

#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <Eigen/Geometry>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/mesh/work_budget.h"

#include "measure/mesh_pieces.h"
#include "repair/surface_mesh.h"
#include "repair/surface_operations.h"

namespace doorforge {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

// Lets a union that takes too long be given up: it is asked between the steps of its long loops.
struct WithinBudget : pmp::Corefinement::Default_visitor<SurfaceMesh> {
  void progress_filtering_intersections(double) const { CheckWork(kSteps); }
  void intersection_of_coplanar_faces_step() const { CheckWork(kSteps); }
  void edge_face_intersections_step() const { CheckWork(kSteps); }
  void triangulating_faces_step() const { CheckWork(kSteps); }
  void after_subface_created(face_descriptor, SurfaceMesh&) { CheckWork(kSteps); }
  void after_face_copy(face_descriptor, const SurfaceMesh&, face_descriptor, SurfaceMesh&) {
    CheckWork(kSteps);
  }

  static constexpr unsigned kSteps = 100;
};

// Grown by about `shift_m` on every side and, where that is asked for, turned by as little. Boards
// that were drawn flush then overlap in general position, which is what corefinement handles well:
// no faces in one plane.
TriangleMesh Nudged(TriangleMesh solid, const Nudge& nudge, Rng& rng) {
  const double shift_m = nudge.shift_m;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : solid.vertices) box.extend(vertex);
  const Eigen::Vector3d center = box.center();
  const double longest = box.sizes().maxCoeff();
  Eigen::Vector3d scale, turn, move;
  for (int axis = 0; axis < 3; ++axis) {
    const double grown = 2 * shift_m * rng.Uniform(0.7, 1.3);
    scale[axis] = 1 + grown / std::max(box.sizes()[axis], 10 * shift_m);
    turn[axis] = shift_m / longest * rng.Uniform(-0.3, 0.3);
    move[axis] = shift_m * rng.Uniform(-0.2, 0.2);
  }
  if (!nudge.turns) turn.setZero();
  const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(turn.x(), Eigen::Vector3d::UnitX()) *
                                    Eigen::AngleAxisd(turn.y(), Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(turn.z(), Eigen::Vector3d::UnitZ()))
                                       .toRotationMatrix();
  for (Eigen::Vector3d& vertex : solid.vertices)
    vertex = center + move + rotation * scale.cwiseProduct(vertex - center);
  return solid;
}

}  // namespace

std::optional<TriangleMesh> United(const std::vector<TriangleMesh>& solids, const Nudge& nudge) {
  Rng rng(nudge.seed, "mesh/united");
  std::vector<SurfaceMesh> surfaces;
  for (const TriangleMesh& solid : solids) surfaces.push_back(SurfaceOf(Nudged(solid, nudge, rng)));
  try {
    // neighbours first, so that most unions are of small surfaces
    while (surfaces.size() > 1) {
      std::vector<SurfaceMesh> halved;
      for (std::size_t i = 0; i + 1 < surfaces.size(); i += 2) {
        SurfaceMesh& both = halved.emplace_back();
        const bool done = pmp::corefine_and_compute_union(
            surfaces[i], surfaces[i + 1], both,
            CGAL::parameters::throw_on_self_intersection(true).visitor(WithinBudget()));
        if (!done) return std::nullopt;
        // CGAL numbers what is new by addresses
        both = SurfaceOf(InCanonicalOrder(TrianglesOf(both)));
      }
      if (surfaces.size() % 2 == 1) halved.push_back(std::move(surfaces.back()));
      surfaces = std::move(halved);
    }
  } catch (const Error&) {
    throw;  // the budget is used up
  } catch (const std::exception&) {
    return std::nullopt;  // a solid crosses itself where another meets it
  }
  return TrianglesOf(surfaces.front());
}

}  // namespace doorforge
