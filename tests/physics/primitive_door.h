// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/core/rng.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// A door of boxes and one bar or disc, for tests and benchmarks.
struct PrimitiveDoor {
  Mechanism mechanism = Mechanism::kLever;  ///< kLever, kRound or kNone (a vertical bar to pull).
  double width_m = 0.8;
  double height_m = 1.9;
  double leaf_mass_kg = 15;
  double handle_height_m = 0.85;
  double stand_off_m = 0.055;  ///< From the leaf's surface to the middle of the bar.
  double length_m = 0.14;      ///< Of the bar.
  double thickness_m = 0.02;
  double radius_m = 0.028;       ///< Of the knob.
  double grasp_fraction = 0.65;  ///< Where along the lever.
  HingeSide hinge_side = HingeSide::kLeft;
  Opening opening = Opening::kPull;
};

/// The ranges of docs/design/simulation.md.
PrimitiveDoor RandomPrimitive(Mechanism mechanism, std::uint64_t seed, std::uint64_t index);

/// Handle range 45 degrees, unlocks at 65 % of it; the paper's latch unless the mechanism is kNone.
DoorAsset MakePrimitiveDoor(const PrimitiveDoor& door);

/// About the hinge line, which leaf and handle turn about together.
double InertiaAboutHinge(const DoorAsset& door);

TriangleMesh BoxMesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

}  // namespace doorforge
