// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "doorforge/core/triangle_mesh.h"

// What CGAL does for this room. Its headers take gigabytes and minutes to compile, so only six
// sources include them: those behind this header, which are close_soup.cpp, mend_crossings.cpp,
// remove_slivers.cpp, unite_solids.cpp and wrap_surface.cpp, and triangle_crossing.cpp. Indices
// must be in range and vertices finite. All deterministic.

namespace doorforge {

/// A hole is filled if it is small, or flat, not large, and closed by little beside the area of its
/// piece; and if its cap keeps near what is around.
struct HoleLimits {
  double max_size_m = 0;           ///< Diagonal of the bounding box.
  double max_flat_size_m = 0;      ///< A flat hole may be so large.
  double max_flat_area_share = 0;  ///< It may take up this share of its piece's area.
  double flatness_m = 0;           ///< How far a flat hole's border may leave its plane.
  double max_cap_distance_m = 0;   ///< How far a point of its cap may lie from what is around.
};

struct ClosedSoup {
  TriangleMesh mesh;  ///< Manifold and consistently oriented; may have boundaries.
  int duplicate_triangles = 0;
  int degenerate_triangles = 0;  ///< Those with a repeated corner.
  int split_vertices = 0;        ///< Copies made where the surface was not manifold.
  int holes_filled = 0;
  int far_caps = 0;  ///< Holes that would have been filled but for their caps' distance.
};

/// Makes an oriented surface of a triangle soup: duplicate and degenerate triangles dropped,
/// neighbours turned to agree, non-manifold places cut apart, borders that fit stitched, holes
/// filled with triangles between their own vertices. `around` is what caps must keep near to: the
/// soup, or all that it is a part of.
ClosedSoup CloseSoup(const TriangleMesh& soup, const HoleLimits& holes, const TriangleMesh& around);

/// The pairs of triangles of the manifold mesh that cross or touch, other than in a shared vertex
/// or edge; indices in increasing order.
std::vector<std::pair<int, int>> CrossingTriangles(const TriangleMesh& mesh);

/// Whether there is such a pair; quicker where there are many.
bool SelfIntersects(const TriangleMesh& mesh);

/// The closed mesh with the few places where its triangles cross drawn anew, each by moving the
/// vertices there or by cutting a patch out and filling the hole; the rest stays as it is. Nothing
/// where many cross, or of so many triangles that it takes seconds, or some do still. How far the
/// patches lie from what they stand for is not bounded.
std::optional<TriangleMesh> WithCrossingsMended(const TriangleMesh& mesh);

/// How solids are moved before they are united. Faces of boards that were drawn flush come to lie
/// in parallel planes then; turned, they cross at small angles, which leaves more slivers, but
/// parts slanted and curved faces too.
struct Nudge {
  double shift_m = 0;      ///< Each is grown by about this, and moved by less.
  bool turns = false;      ///< And turned by as little.
  std::uint64_t seed = 0;  ///< Of what differs from solid to solid.
};

/// One surface around closed, outward oriented solids, none of which crosses itself; cavities that
/// close between them stay, oriented inwards. Nothing where the solids do not unite to a manifold
/// surface; the result may cross itself by rounding.
std::optional<TriangleMesh> United(const std::vector<TriangleMesh>& solids, const Nudge& nudge);

/// Alpha wrap (Portaneri et al. 2022): closed, oriented, without self-intersections, `offset_m`
/// outside of the triangles, entering openings wider than about `alpha_m`.
TriangleMesh AlphaWrap(const TriangleMesh& soup, double alpha_m, double offset_m);

/// The closed mesh after all collapses of edges that cost at most `free_error_m` by quadrics
/// (Garland and Heckbert 1997), among them those of slivers, which Reduced() refuses where others
/// stay beside them. The result is closed, but triangles may cross.
TriangleMesh WithoutSlivers(const TriangleMesh& mesh, double free_error_m);

}  // namespace doorforge
