// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/datagen/door_split.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// Composed doors with the hashes that identify them, sorted by id.
struct DoorFolder {
  std::vector<DoorAsset> doors;
  std::vector<std::string> sha256;  ///< ContentHash() of each.
};

/// Reads every folder at or below `folder` that holds a door.json.
///
/// @throws Error(kMissing) if there is none, Error(kFormat) that lists every door that cannot be
///     read, Error(kInvalidArgument) if two doors have one id.
DoorFolder ReadDoorFolder(const std::filesystem::path& folder, int threads);

/// What the plan needs of the doors, in their order.
std::vector<DoorParts> PartsOf(const DoorFolder& folder);
/// What the dataset records of the doors, in their order; splits are left empty.
std::vector<DatasetDoor> RecordsOf(const DoorFolder& folder);
/// Hash over ids and content hashes.
std::string ContentHash(const DoorFolder& folder);

}  // namespace doorforge
