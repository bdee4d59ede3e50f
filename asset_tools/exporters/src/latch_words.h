// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "doorforge/schemas/door_asset.h"

namespace doorforge::internal {

/// What of a door no format has a word for, as names and texts: the latch's law with all its
/// numbers, category, mechanism, side and opening. Names are those of Latch and DoorAsset.
std::vector<std::pair<std::string, std::string>> LatchWords(const DoorAsset& door);
std::vector<std::pair<std::string, std::string>> DoorWords(const DoorAsset& door);

}  // namespace doorforge::internal
