// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// Where two solids reach into each other, found by points on their surfaces alone: it knows
/// nothing of convex parts, and so can judge them.
class SolidOverlap {
 public:
  /// Closed meshes, outward orientation; pieces that overlap count as their union.
  SolidOverlap(const TriangleMesh& moving, const TriangleMesh& fixed);
  ~SolidOverlap();
  SolidOverlap(const SolidOverlap&) = delete;
  SolidOverlap& operator=(const SolidOverlap&) = delete;

  /// Points of either surface that lie in the other solid and in all of the convex `regions`, in
  /// the frame of `fixed`: corners, edges and faces of the triangles at most `step_m` apart.
  /// Deterministic. Empty where the solids do not meet there.
  std::vector<Eigen::Vector3d> CommonSurface(const RigidTransform& fixed_from_moving,
                                             std::span<const TriangleMesh> regions,
                                             double step_m) const;

  /// How far the solids are in each other along a line, in the sense in which the two convex
  /// `pieces` (the moving solid's, the fixed one's, in the frame of `fixed`) come apart soonest:
  /// from where the fixed solid begins to where the moving one ends, each no farther than its
  /// piece, at the point of `common` where that is most. `common` is what CommonSurface() found in
  /// both pieces; 0 where that is empty. For convex solids that are their own pieces it is the
  /// pieces' overlap along that line, which the common surface alone does not tell: a small solid
  /// deep in a large one has a small surface.
  double DepthAlong(const RigidTransform& fixed_from_moving,
                    std::span<const TriangleMesh, 2> pieces, const Eigen::Vector3d& line,
                    std::span<const Eigen::Vector3d> common) const;

 private:
  struct Surfaces;
  std::unique_ptr<const Surfaces> surfaces_;
};

/// The least extent of points along the directions of `also` and thirteen that are spread evenly:
/// how far one of two convex solids would have to move to leave a common volume with that surface.
/// 0 for fewer than two points.
double LeastExtent(std::span<const Eigen::Vector3d> points, std::span<const Eigen::Vector3d> also);

}  // namespace doorforge
