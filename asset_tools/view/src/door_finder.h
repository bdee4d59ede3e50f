// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "doorforge/schemas/door_set.h"

namespace doorforge::internal {

/// Doors of episodes, by their hashes.
class DoorFinder {
 public:
  /// Throws as FindDoorSet().
  DoorFinder(std::span<const std::filesystem::path> folders, int threads);

  /// The door with this hash; nothing where there is none.
  std::optional<IdentifiedDoor> Find(const std::string& sha256);

 private:
  DoorSet set_;
  DoorCache cache_;
};

}  // namespace doorforge::internal
