// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "doorforge/evaluate/report.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// Reads every composed door at or below the folders (those that hold `door.json`), sorted by id.
///
/// @throws Error(kMissing) if a folder does not exist or holds no door, Error(kFormat) as
///     ReadDoor(), Error(kInvalidArgument) if an id occurs twice with different content; the same
///     door given twice counts once.
std::vector<DoorAsset> ReadDoors(const std::vector<std::string>& folders);

/// What a report says of a door.
ReportDoor ReportDoorOf(const DoorAsset& door);

}  // namespace doorforge
