// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// The surface moved by `distance_m` along its normals. Each vertex goes where the planes of its
/// triangles go, so that edges stay sharp, but no farther than three times the distance.
TriangleMesh Offset(const TriangleMesh& mesh, double distance_m);

/// The parts of a surface between its sharp edges: triangles that meet in an edge at less than 30
/// degrees, or a surface without such an edge cut in two across its longest extent. One part for a
/// single triangle.
std::vector<TriangleMesh> Patches(const TriangleMesh& surface);

/// The solid between the surface moved outwards and inwards by `distance_m`, with walls along its
/// borders. The surface must be manifold and consistently oriented; the solid is closed, but
/// crosses itself where the surface folds more tightly than its thickness.
TriangleMesh Thickened(const TriangleMesh& sheet, double distance_m);

}  // namespace doorforge
