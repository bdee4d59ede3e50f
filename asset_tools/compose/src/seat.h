// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"
#include "doorforge/parts/line_hits.h"

namespace doorforge::internal {

/// Where a handle's back touches: the handle's points within a few millimetres of its rearmost.
struct BackOutline {
  double rear_m;          ///< Smallest x of the handle.
  Eigen::Vector2d min_m;  ///< In (y, z).
  Eigen::Vector2d max_m;
  std::vector<Eigen::Vector2d> samples;  ///< Points of the back, (y, z); at least one.
};

/// `handle` in its own frame: all pieces as one mesh, not empty.
BackOutline BackOutlineOf(const TriangleMesh& handle);

/// What a handle is seated on, in the body's frame.
struct LeafSurface {
  explicit LeafSurface(const TriangleMesh& leaf);

  Eigen::AlignedBox3d bounds;
  LinesAlongX lines;
};

/// Whether the back is no larger than the leaf.
bool FitsOn(const LeafSurface& leaf, const BackOutline& back);

/// x of the leaf's surface behind the back of a handle whose frame is at (y, z). Empty if the leaf
/// has no surface there.
std::optional<double> SurfaceBehind(const LeafSurface& leaf, const BackOutline& back,
                                    const Eigen::Vector2d& at_m);

/// The translation that brings the back onto the leaf, starting from `mount_m` in the body's frame.
/// Empty, with no guess, if the leaf has no surface there or is smaller than the back.
std::optional<Eigen::Vector3d> SeatOn(const LeafSurface& leaf, const BackOutline& back,
                                      const Eigen::Vector3d& mount_m);

}  // namespace doorforge::internal
