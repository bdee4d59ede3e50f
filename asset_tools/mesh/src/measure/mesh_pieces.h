// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// Vertices within `distance_m` of an earlier one become that one; unused ones go. Triangles that
/// lose a corner stay, with a repeated index.
TriangleMesh Welded(const TriangleMesh& mesh, double distance_m);

/// The sets of triangles connected through edges, each a mesh of its own, in order of their first
/// triangle.
std::vector<TriangleMesh> PiecesOf(const TriangleMesh& mesh);

/// Vertices in lexicographic order.
TriangleMesh InVertexOrder(const TriangleMesh& mesh);

/// Sorts the vertices as InVertexOrder() does, and the triangles by their corners, from the
/// smallest: a surface gets one order, however it was numbered.
TriangleMesh InCanonicalOrder(const TriangleMesh& mesh);

TriangleMesh TurnedInsideOut(TriangleMesh mesh);

}  // namespace doorforge
