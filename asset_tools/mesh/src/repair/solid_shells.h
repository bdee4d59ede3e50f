// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// A soup in which solids share edges or faces, as boards do that are drawn flush and welded.
struct SolidShells {
  std::vector<TriangleMesh> shells;  ///< Closed, manifold, facing outwards, each with its vertices.
  TriangleMesh rest;                 ///< What belongs to none of them and lies on none of them.
  int split_vertices = 0;            ///< Copies made of vertices that shells share.
};

/// Takes solids apart at the edges where more than two triangles meet: around such an edge, a
/// triangle's neighbour is the one that bounds the matter behind it on its other side, which
/// windings tell (as brackets of angles, an inner pair before the one around it). What comes out
/// closed, around a positive volume and thicker than `thinnest_m` (twice its volume by its area) is
/// a shell, if it has such an edge in common with another. Where none comes out so, all is `rest`,
/// as it was. Triangles with a repeated corner stay in it. Deterministic, O(T log T).
SolidShells SolidShellsOf(const TriangleMesh& soup, double thinnest_m);

}  // namespace doorforge
