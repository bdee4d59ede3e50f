// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "door_finder.h"

#include <algorithm>

namespace doorforge::internal {

namespace fs = std::filesystem;

DoorFinder::DoorFinder(std::span<const fs::path> folders, int threads)
    : set_(FindDoorSet({.folders = {folders.begin(), folders.end()}}, threads)),
      cache_(set_.doors) {}

std::optional<IdentifiedDoor> DoorFinder::Find(const std::string& sha256) {
  const auto found = std::ranges::find_if(
      set_.doors, [&](const FoundDoor& door) { return door.identity.sha256 == sha256; });
  if (found == set_.doors.end()) return std::nullopt;
  return cache_.Take(static_cast<std::size_t>(found - set_.doors.begin()));
}

}  // namespace doorforge::internal
