// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/schemas/bolt.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge::internal {

/// A convex piece of the frame, in the base's frame, with its file relative to the export.
struct FramePiece {
  std::string name;
  std::string file;
  TriangleMesh hull;
};

/// The latch as bodies, for formats whose readers let every link touch every other: a bolt that
/// slides in the leaf, a strike on the frame, and a mortise, without which the bolt would meet the
/// frame's own shapes. The strike stands as far out as the leaf needs to pass it, and the bolt with
/// it. docs/design/exports.md has the reasons.
struct LatchBodies {
  Bolt bolt;
  std::vector<FramePiece> frame;  ///< All that touches of the frame; the strike is the last.
  /// Coulomb friction of the handle [N m] that keeps its weight from turning it, for formats
  /// without springs.
  double handle_friction_nm = 0;
};

inline constexpr const char* kBoltMeshPath = "meshes/latch/bolt.obj";
inline constexpr const char* kStrikeMeshPath = "meshes/latch/strike.obj";
/// The strike in its own frame, for formats that place it themselves.
inline constexpr const char* kStrikeHullPath = "meshes/latch/strike_hull.obj";

/// Nothing for a door without a latch, or whose handle does not turn. Throws as BoltOf().
std::optional<LatchBodies> LatchBodiesOf(const DoorAsset& door);

/// Bolt and strike where the simulated world has them, for a format that can name what does not
/// touch, and the pieces of the frame, without the strike, that the mortise of this bolt leaves: it
/// begins farther in. For readers that take no account of what is named.
std::optional<LatchBodies> LatchBodiesInPlace(const DoorAsset& door);

/// Writes meshes/latch: bolt, strike, its hull and what the mortise left of the shapes that it
/// cuts.
void WriteLatchMeshes(const LatchBodies& latch, const std::filesystem::path& folder);

/// What joins the bolt to the leaf: position 0 thrown, negative drawn back.
inline constexpr const char* kBoltLink = "bolt";
inline constexpr const char* kBoltJoint = "bolt_joint";
/// Mass properties in the bolt's frame.
MassProperties BoltMass(const Bolt& bolt);
/// Speed [m/s] and force [N] that a bolt's joint is limited to.
inline constexpr double kBoltSpeed = 1;
inline constexpr double kBoltForce = 100;

}  // namespace doorforge::internal
