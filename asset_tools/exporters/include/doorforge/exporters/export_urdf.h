// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "doorforge/core/committed_file.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/urdf.h"

namespace doorforge {

/// The door as a URDF that names the meshes WriteDoor() writes, relative to its folder: links
/// "base", "leaf" and "handle" with inertials, joints "hinge" and "handle_joint" with effort and
/// velocity limits and damping, scale baked into the meshes. A handle that does not turn is fixed.
/// The latch has no counterpart in URDF; it stays in door.json. A visual is what its author drew,
/// with its own materials, or else the closed mesh in its colour. MuJoCo is told to leave visuals
/// out where one is drawn by an author: it takes closed meshes alone.
UrdfModel ToUrdfModel(const DoorAsset& door);
/// Makes the same model with the meshes where `files` says, in the pool that doors share or
/// elsewhere.
UrdfModel ToUrdfModel(const DoorAsset& door, const DoorFiles& files);

/// Commits `folder` with door.json, meshes/ and model.urdf, all or nothing.
void WriteDoorFolder(const DoorAsset& door, const std::filesystem::path& folder, Existing existing);

}  // namespace doorforge
