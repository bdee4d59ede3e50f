// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "doorforge/core/triangle_mesh.h"

// Closed solids by construction: the families of the catalogue are built from these without any
// boolean operation, so every mesh is closed and its convex pieces are known.

namespace doorforge::internal {

/// A closed mesh with the convex pieces that stand for it.
struct Solid {
  TriangleMesh mesh;
  std::vector<TriangleMesh> hulls;
};

/// One cross-section of a loft: points counter-clockwise as seen by someone whom the loft comes
/// towards.
using Ring = std::vector<Eigen::Vector3d>;

/// The closed mesh through rings of equal length (at least 2 rings of at least 3 points), with flat
/// caps fanned around the centres of the first and the last ring: each must be star-shaped around
/// its centre. Volume is positive.
TriangleMesh Loft(const std::vector<Ring>& rings);

/// Loft() that goes on from the last ring to the first: a hoop without caps. Volume is positive if
/// the rings run around their common axis in the sense that Loft() asks of each.
TriangleMesh LoftLoop(const std::vector<Ring>& rings);

/// Loft() of rings whose end caps are not star-shaped: all rings are copies of one flat polygon
/// with these plane coordinates, counter-clockwise, and the caps are cut by ear clipping.
TriangleMesh LoftProfile(const std::vector<Ring>& rings,
                         const std::vector<Eigen::Vector2d>& profile);

/// Convex pieces of Loft(rings): consecutive rings are joined as long as the hull lies nowhere
/// more than `tolerance_m` above the loft's surface and has at most 64 vertices. Together the
/// pieces cover the loft if every ring is convex.
std::vector<TriangleMesh> LoftHulls(const std::vector<Ring>& rings, double tolerance_m);

Solid LoftSolid(const std::vector<Ring>& rings, double hull_tolerance_m);

/// Axis-aligned box, 8 vertices.
TriangleMesh BoxMesh(const Eigen::Vector3d& min_m, const Eigen::Vector3d& max_m);

/// All meshes and hulls side by side; the solids may touch.
Solid Joined(const std::vector<Solid>& solids);

Solid Moved(Solid solid, const Eigen::Vector3d& offset_m);

/// Plane polygon of a rectangle with rounded corners, centred, counter-clockwise, 4 (segments + 1)
/// points. A radius of half the smaller side gives a stadium or a circle.
std::vector<Eigen::Vector2d> RoundedRectangle(const Eigen::Vector2d& half_size_m, double radius_m,
                                              int segments);

/// A rounded rectangle in the plane x = 0 with `half_size_m` along (y, z) around `center`, extruded
/// to x = thickness; its front edge is rounded.
struct PlateShape {
  Eigen::Vector2d half_size_m{0.025, 0.025};
  double corner_radius_m = 0.025;  ///< At most the smaller half size.
  double thickness_m = 0.008;
  double edge_radius_m = 0.002;  ///< Less than thickness and corner radius.
};
Solid PlateSolid(const PlateShape& shape, const Eigen::Vector2d& center);

/// A box with all twelve edges chamfered by `edge_m`; one hull.
Solid ChamferedBox(const Eigen::Vector3d& min_m, const Eigen::Vector3d& max_m, double edge_m);

}  // namespace doorforge::internal
