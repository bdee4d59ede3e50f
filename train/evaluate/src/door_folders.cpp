// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/evaluate/door_folders.h"

#include <algorithm>
#include <set>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

std::set<fs::path> DoorsBelow(const fs::path& folder) {
  if (!fs::is_directory(folder))
    throw Error(ErrorCode::kMissing,
                folder.string() +
                    ": no such folder; --doors takes folders of composed doors "
                    "(`doorforge compose`)");
  std::set<fs::path> found;
  if (fs::exists(folder / "door.json")) found.insert(folder);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().filename() == "door.json") found.insert(entry.path().parent_path());
  }
  if (found.empty())
    throw Error(ErrorCode::kMissing, folder.string() +
                                         ": no door.json in it; `doorforge compose` makes doors of "
                                         "parts, `doorforge import` parts of foreign objects");
  return found;
}

}  // namespace

std::vector<DoorAsset> ReadDoors(const std::vector<std::string>& folders) {
  std::vector<DoorAsset> doors;
  for (const std::string& folder : folders) {
    for (const fs::path& path : DoorsBelow(folder)) doors.push_back(ReadDoor(path));
  }
  std::stable_sort(doors.begin(), doors.end(),
                   [](const auto& a, const auto& b) { return a.id < b.id; });
  for (std::size_t i = 1; i < doors.size(); ++i) {
    if (doors[i].id != doors[i - 1].id) continue;
    if (ContentHash(doors[i]) != ContentHash(doors[i - 1]))
      throw Error(ErrorCode::kInvalidArgument,
                  "two different doors have the id \"" + doors[i].id + "\"; rename one");
    doors.erase(doors.begin() + static_cast<std::ptrdiff_t>(i--));
  }
  return doors;
}

ReportDoor ReportDoorOf(const DoorAsset& door) {
  return {.id = door.id,
          .category = door.category,
          .mechanism = door.mechanism,
          .body = door.body,
          .handle = door.handle,
          .sha256 = ContentHash(door),
          .license = door.license};
}

}  // namespace doorforge
