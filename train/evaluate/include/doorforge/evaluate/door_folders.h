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

/// Which of the doors in a folder are meant.
struct DoorSelection {
  /// A split's name in data/splits, or its file, and a side: "full:test", "full:unseen_categories",
  /// "full:train"; without a side it is test. Doors are meant whose body and handle are both on
  /// that side. Empty: all.
  std::string split;
  /// At most so many of each category, evenly from the list by id; 0: all.
  int per_category = 0;
};

/// Reads the composed doors at or below the folders (those that hold `door.json`) that the
/// selection means, sorted by id.
///
/// @throws Error(kMissing) if a folder does not exist or holds no door, or the selection means
/// none;
///     as ReadSplit(); Error(kInvalidArgument) on an unknown side; Error(kFormat) as
///     ReadDoor(), Error(kInvalidArgument) if an id occurs twice with different content; the same
///     door given twice counts once.
std::vector<DoorAsset> ReadDoors(const std::vector<std::string>& folders,
                                 const DoorSelection& selection = {});

/// What a report says of a door.
ReportDoor ReportDoorOf(const DoorAsset& door);

}  // namespace doorforge
