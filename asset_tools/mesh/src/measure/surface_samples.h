// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// About `count` points spread evenly over the area, in the order of the triangles. The same on
/// every call. Large triangles get many points, small ones share: the running area decides.
std::vector<Eigen::Vector3d> SurfaceSamples(const TriangleMesh& mesh, int count);

}  // namespace doorforge
