// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// Unit normals for the three corners of each triangle: the mean of the faces that meet at the
/// corner's position and deviate from the triangle by less than `crease_rad`, weighted by area.
/// Vertices at equal positions count as one, so split meshes shade like welded ones.
std::vector<std::array<Eigen::Vector3f, 3>> SmoothNormals(const TriangleMesh& mesh,
                                                          double crease_rad);

}  // namespace doorforge
