// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "doorforge/schemas/names.h"

namespace doorforge {

struct DoorAsset;

/// What is known of a door whose parts and poses are annotated, and does not change in an episode:
/// the ground truth that baselines get. Only rules may read it.
struct DoorFacts {
  Category category = Category::kInterior;
  Mechanism mechanism = Mechanism::kNone;
  HingeSide hinge_side = HingeSide::kLeft;
  /// Around all meshes of the handle, in the handle's frame [m]: x out of the leaf, z up.
  Eigen::AlignedBox3d handle_box;
  /// An open door, too, is locked where it stands as soon as the handle goes back, see
  /// LatchProperties::relatch.
  bool relatches = false;
};
DoorFacts FactsOf(const DoorAsset& door);

}  // namespace doorforge
