// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/find_doors.h"

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

std::set<fs::path> DoorsBelow(const fs::path& folder) {
  if (!fs::is_directory(folder))
    throw Error(ErrorCode::kMissing, folder.string() + ": no such folder of doors");
  std::set<fs::path> found;
  if (fs::exists(folder / "door.json")) found.insert(folder);
  const auto end = fs::recursive_directory_iterator();
  for (auto entry = fs::recursive_directory_iterator(folder); entry != end; ++entry) {
    const fs::path name = entry->path().filename();
    if (name == "door.json") found.insert(entry->path().parent_path());
    // what a killed program left
    if (name.string().starts_with('.') && entry->is_directory()) entry.disable_recursion_pending();
  }
  if (found.empty())
    throw Error(ErrorCode::kMissing,
                folder.string() +
                    ": no door.json at or below this folder; `doorforge compose` makes doors of "
                    "parts, `doorforge import` parts of foreign objects");
  return found;
}

}  // namespace

std::set<fs::path> FindDoors(const std::vector<fs::path>& folders) {
  std::set<fs::path> found;
  for (const fs::path& folder : folders) found.merge(DoorsBelow(folder));
  return found;
}

}  // namespace doorforge
