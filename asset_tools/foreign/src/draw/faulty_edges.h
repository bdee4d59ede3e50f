// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge::foreign {

using Edge = std::array<Eigen::Vector3d, 2>;

/// The edges that a finding of GEO009, GEO010, GEO011, GEO012 or GEO017 counts, of the triangles
/// with equal positions as one vertex; of degenerate and repeated triangles all their edges. Empty
/// for other codes. At most `most`, in the order of the positions' numbers.
std::vector<Edge> FaultyEdges(const TriangleMesh& mesh, std::string_view code, std::size_t most);

/// The mesh with fewer triangles, at most about `most`: vertices within the cells of a grid become
/// one, and triangles without area go. Returns the mesh itself where it has no more.
TriangleMesh Coarser(const TriangleMesh& mesh, std::size_t most);

}  // namespace doorforge::foreign
