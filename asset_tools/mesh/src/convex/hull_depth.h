// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "doorforge/core/triangle_mesh.h"

#include "measure/distance_grid.h"
#include "measure/measured_distances.h"

namespace doorforge {

/// A place in or on a hull that is far from the solid.
struct Concavity {
  double depth_m = 0;
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  ///< It means nothing at depth 0.
};

/// No depth is so deep.
inline constexpr double kNoStop = 1e300;

/// Which depths are of interest.
struct DepthRange {
  double above_m = 0;       ///< What is no deeper counts as depth 0.
  double stop_m = kNoStop;  ///< Where there is something deeper than this, any such depth will do.
  double step_m = 0;        ///< By so much the depth of a cell that is found may be too little.
};

/// The cell inside a hull that is farthest from the solid. Inside is what has its centre there; of
/// a hull so thin that it may hold no centre, every cell that it has a point in.
Concavity ConcavityOf(const TriangleMesh& hull, const DistanceGrid& solid,
                      const DepthRange& range = {});

/// The point of the hull's surface in air that is farthest from the solid's surface, if it is
/// farther than `range.above_m`, which must be positive. Found to within `step_m` of its place and
/// a thirtieth of its depth.
Concavity ProtrusionOf(const TriangleMesh& hull, MeasuredDistances& distances,
                       const DepthRange& range, double step_m);

}  // namespace doorforge
