// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace doorforge {

/// A door or part that something else says is there, and whose record is not.
struct MissingRecord {
  std::filesystem::path folder;
  std::string record;   ///< "door.json" or "part.json".
  std::string told_by;  ///< What says that it was there, for people.
};

/// At or below a folder, sorted: doors that door_index.json names and no door.json there is of,
/// whatever its folder is called; folders with the other files that `doorforge compose` and
/// `doorforge import` write beside a record. Empty for what is no folder. Throws as
/// ReadDoorIndex().
std::vector<MissingRecord> FindMissingRecords(const std::filesystem::path& path);

}  // namespace doorforge
