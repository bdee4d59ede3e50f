// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/mesh/convex_parts.h"
#include "doorforge/mesh/work_budget.h"

#include "convex/convex_region.h"
#include "measure/surface_samples.h"
#include "measure/triangle_tree.h"

namespace doorforge {
namespace {

constexpr int kSamples = 4000;

std::vector<Eigen::Vector3d> Probes(const TriangleMesh& mesh, int count) {
  std::vector<Eigen::Vector3d> probes = SurfaceSamples(mesh, count);
  probes.insert(probes.end(), mesh.vertices.begin(), mesh.vertices.end());
  return probes;
}

bool IsConvex(const TriangleMesh& part) {
  if (!ClosedMesh::From(part)) return false;
  const double tolerance_m = 1e-6 * MeasureTopology(part).bounds.diagonal().norm();
  for (const HalfSpace& face : HalfSpacesOf(part)) {
    CheckWork(static_cast<unsigned>(part.vertices.size()));
    for (const Eigen::Vector3d& vertex : part.vertices) {
      if (face.normal.dot(vertex) > face.offset + tolerance_m) return false;
    }
  }
  return true;
}

// Largest distance from a probe that `is_outside` to the tree. The costly question is asked for
// the farthest probes only, until one says yes.
template <class IsOutside>
double FarthestOutside(const std::vector<Eigen::Vector3d>& probes, const TriangleTree& tree,
                       const IsOutside& is_outside) {
  std::vector<std::pair<double, std::size_t>> by_distance;
  for (std::size_t i = 0; i < probes.size(); ++i)
    by_distance.emplace_back(-tree.Distance(probes[i]), i);
  std::sort(by_distance.begin(), by_distance.end());
  for (const auto& [negative, index] : by_distance) {
    if (negative == 0) break;
    if (is_outside(probes[index])) return -negative;
  }
  return 0;
}

}  // namespace

ConvexPartsFit MeasureConvexParts(const ClosedMesh& mesh, std::span<const TriangleMesh> parts) {
  Require(!parts.empty(), ErrorCode::kInvalidArgument, "there are no convex parts to measure");
  const TriangleTree mesh_tree(mesh.mesh());
  std::vector<std::vector<HalfSpace>> faces;
  std::vector<Eigen::Vector3d> part_probes;
  for (const TriangleMesh& part : parts) {
    Require(IsConvex(part), ErrorCode::kInvalidArgument, "a convex part is not closed and convex");
    faces.push_back(HalfSpacesOf(part));
    const std::vector<Eigen::Vector3d> probes =
        Probes(part, kSamples / static_cast<int>(parts.size()) + 200);
    part_probes.insert(part_probes.end(), probes.begin(), probes.end());
  }
  const auto in_no_part = [&](const Eigen::Vector3d& point) {
    return std::none_of(faces.begin(), faces.end(), [&](const std::vector<HalfSpace>& part) {
      return std::all_of(part.begin(), part.end(), [&](const HalfSpace& face) {
        return face.normal.dot(point) <= face.offset;
      });
    });
  };
  ConvexPartsFit fit;
  fit.protrusion_m = FarthestOutside(part_probes, mesh_tree, [&](const Eigen::Vector3d& point) {
    return !mesh_tree.IsInside(point);
  });
  fit.uncovered_m =
      FarthestOutside(Probes(mesh.mesh(), kSamples), TriangleTree(Merged(parts)), in_no_part);
  return fit;
}

}  // namespace doorforge
