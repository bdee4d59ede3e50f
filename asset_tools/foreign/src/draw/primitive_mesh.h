// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/core/triangle_mesh.h"

namespace doorforge::foreign {

/// @name Primitive shapes about the origin, as a page draws them
/// Triangles run counter-clockwise seen from outside; round ones have 32 corners about z.
/// @{
TriangleMesh BoxMesh(const Eigen::Vector3d& size_m);
TriangleMesh CylinderMesh(double radius_m, double length_m);  ///< Along z.
TriangleMesh SphereMesh(double radius_m);
/// @}

}  // namespace doorforge::foreign
