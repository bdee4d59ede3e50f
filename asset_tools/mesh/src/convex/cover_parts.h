// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/core/closed_mesh.h"

#include "measure/distance_grid.h"

namespace doorforge {

struct CoverLimits {
  double tolerance_m = 0;  ///< What may be left out.
  double allowed_m = 0;    ///< How deep an added part may reach into air.
  int max_parts = 0;
  int max_vertices = 0;  ///< A part has at most so many.
};

/// The parts and what it takes for them to cover the mesh's surface: parts of their own where there
/// is room, else the parts nearest by grow. Thin parts are widened to 0.2 mm, which physics and
/// mesh files need.
std::vector<TriangleMesh> Covering(std::vector<TriangleMesh> parts, const ClosedMesh& mesh,
                                   const DistanceGrid& solid, const CoverLimits& limits);

}  // namespace doorforge
