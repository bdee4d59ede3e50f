// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "findings.h"
#include "record_meshes.h"

namespace doorforge::internal {

/// A handle on its leaf, in the leaf's frame. No mesh is empty.
struct StandingHandle {
  const LeafLines& leaf;
  const TriangleMesh& grip;
  const TriangleMesh& handle;  ///< Grip and rose.
  double surface_m;            ///< x of the leaf's surface at the handle's mount.
  Mechanism mechanism;
  bool on_leaf;  ///< It lies within the leaf's outline.
};

/// HND009 to HND011: whether it stands as handles do.
Findings CheckStance(const StandingHandle& standing);

/// Distance from the leaf to what of the handle is nearest to it [m]; negative inside the leaf,
/// infinite where no part of the leaf lies behind the handle.
double GapToLeaf(const LeafLines& leaf, const TriangleMesh& handle);

/// Angle between the direction that a handle is longest in and the plane x = 0 [rad], 0 to pi/2.
/// The direction is that of the surface's largest second moment, of the whole or of the front half,
/// whichever is less: a long neck tilts the one, the knob at the end of a crank the other. The mesh
/// has an area.
double TiltFromLeaf(const TriangleMesh& mesh);

}  // namespace doorforge::internal
