// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/compose/compose.h"

namespace doorforge::internal {

/// Throws Error(kInvalidConfig) that names the setting, the value found and what is allowed.
void CheckComposeConfig(const ComposeConfig& config);

/// The first setting that puts the handle elsewhere than its author did, or changes what it is put
/// on; empty if none does. A door hinged right is the mirror image, which keeps the place.
std::string MovesTheHandle(const ComposeConfig& config);

/// Throws Error(kInvalidArgument): "compose: <code> <text of the rule>: <why>".
[[noreturn]] void RefusePair(std::string_view code, const std::string& why);

/// Springs and dampings of one pair: the preset's, then what the config sets.
struct JointNumbers {
  double hinge_spring_nm_per_rad;
  double handle_spring_nm_per_rad;
  double hinge_damping_nm_s;
  double handle_damping_nm_s;
};
JointNumbers JointNumbersOf(const ComposeConfig& config, const std::string& pair);

/// The piece's mass as the config's preset has it. `volume_m3` is that of its mesh.
MassProperties PresetMass(const PartPiece& piece, PartRole role, MassPreset preset);

/// For DoorAsset::physics_source.
std::string PhysicsSourceOf(const ComposeConfig& config);

/// "<body>__<handle>" and what the config changes that one sees: "__right", "__push",
/// "__mirrored", "__turned90", "__s7".
std::string DoorIdOf(const std::string& body, const std::string& handle,
                     const ComposeConfig& config);

/// A factor in 0.95 .. 1.05 by seed and stream; 1 without a seed.
double DrawnFactor(const ComposeConfig& config, const std::string& stream);

}  // namespace doorforge::internal
