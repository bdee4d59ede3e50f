// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// Edge collapse by quadrics (Garland and Heckbert 1997) to at most `max_triangles`, or as near as
/// the topology allows, and below that as long as the sum of squared distances to the planes that a
/// vertex stands for is at most the square of `free_error_m`. The mesh must be closed, indices in
/// range, vertices finite; the result is closed, of the same topology, but triangles may cross.
/// Takes a few microseconds a triangle. Deterministic.
TriangleMesh Reduced(const TriangleMesh& mesh, int max_triangles, double free_error_m);

/// It reduces by collapses after which no triangles cross or touch, if none do before; slower, and
/// it stops above `max_triangles` where every collapse would make some cross.
TriangleMesh ReducedWithoutCrossings(const TriangleMesh& mesh, int max_triangles,
                                     double free_error_m);

}  // namespace doorforge
