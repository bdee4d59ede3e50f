// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// A door with the files that hold its meshes.
struct DoorWithFiles {
  DoorAsset door;
  DoorFiles files;
};

/// ReadDoor() and ReadDoorFiles() in one pass over the parsed door.json of the folder. Throws as
/// they do.
DoorWithFiles ReadDoorWithFiles(const nlohmann::ordered_json& record,
                                const std::filesystem::path& folder, const MeshReader& read_mesh,
                                const VisualReader& read_visual);

}  // namespace doorforge
