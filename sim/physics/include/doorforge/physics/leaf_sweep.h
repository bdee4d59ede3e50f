// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// Where a convex piece of leaf or handle is deepest in one of the frame.
struct SweepOverlap {
  double depth_m = 0;  ///< 0: nothing overlaps.
  double hinge_rad = 0;
  double handle_rad = 0;
  std::string moving;  ///< Name of the geometry on leaf or handle; empty where nothing overlaps.
  std::string fixed;   ///< Name of the frame's geometry.
  double total_m = 0;  ///< The overlap itself, with nothing taken off.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< Unit: along which it is that deep.
  const TriangleMesh* moving_hull = nullptr;            ///< The pieces, in the door.
  const TriangleMesh* fixed_hull = nullptr;
};

struct LeafSweep {
  SweepOverlap closed;  ///< Closed, handle at zero.
  /// While the door opens: depth_m is by how much the overlap of a pair of pieces exceeds that of
  /// the same pair on the closed door.
  SweepOverlap opening;
  /// There is one for each pair of pieces that overlaps more than on the closed door, deepest
  /// first.
  std::vector<SweepOverlap> opening_pairs;
};

/// Moves leaf and handle past the convex pieces of their own frame: the handle from zero to its
/// upper limit on the closed door, then the hinge from zero to its upper limit in steps of at most
/// 2 degrees with the handle at zero and turned. Pieces count without a margin; the handle may
/// touch the leaf. Deterministic. Throws nothing on its own; pieces without vertices are left out.
LeafSweep SweepLeaf(const DoorAsset& door);

}  // namespace doorforge
