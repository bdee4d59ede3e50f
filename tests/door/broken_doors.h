// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// BoxDoor() broken in one way, before or after it is written.
struct BrokenDoor {
  std::string code;  ///< The rule that it breaks.
  std::function<void(DoorAsset&)> edit_door;
  std::function<void(const std::filesystem::path&)> edit_folder;
  std::string measured;  ///< Part of the finding's `measured`.
};

/// At least one for every rule that needs no simulation.
std::vector<BrokenDoor> BrokenDoors();

/// A folder for the tests of this room's validation.
std::filesystem::path ValidationFolder(const std::string& name);

/// Writes a door as ValidationFolder(name).
std::filesystem::path Written(const DoorAsset& door, const std::string& name);
std::filesystem::path Written(const BrokenDoor& broken, const std::string& name);

}  // namespace doorforge
