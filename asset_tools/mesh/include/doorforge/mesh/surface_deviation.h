// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// Distance from sampled points of one surface to the nearest point of another.
struct SurfaceDeviation {
  double mean_m = 0;  ///< Over points spread evenly over the area.
  double max_m = 0;   ///< Over the same points and the vertices.
  int samples = 0;    ///< Points of the mean. 0: nothing to measure, mean and max are then 0.
};

struct DeviationSampling {
  int samples = 4000;  ///< About this many over the area, and at most as many of the vertices.
  /// Only points from which one of `rays` directions, spread over the sphere, leaves the surface's
  /// own bounding box unhindered.
  bool visible_only = false;
  int rays = 64;
};

/// From points of `from` to the surface of `to`, unsigned. Deterministic. Both meshes may be
/// broken. Throws Error(kInvalidArgument) if `to` has no triangle or an index of either is out of
/// range.
SurfaceDeviation DeviationOf(const TriangleMesh& from, const TriangleMesh& to,
                             const DeviationSampling& sampling = {});

}  // namespace doorforge
