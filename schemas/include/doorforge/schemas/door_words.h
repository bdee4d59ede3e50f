// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// What of a door no format has a word for, as names and texts: the latch's law with all its
/// numbers, category, mechanism, side and opening. Names are those of Latch and DoorAsset.
std::vector<std::pair<std::string, std::string>> LatchWords(const Latch& latch);
std::vector<std::pair<std::string, std::string>> DoorWords(const DoorAsset& door);

/// The latch that words with the prefix "latch_" describe, as UrdfModel::words holds them; nothing
/// if there is none. Throws Error(kFormat) that begins with `where` on a word that is missing, or
/// no number where one belongs.
std::optional<Latch> LatchFromWords(const std::map<std::string, std::string>& words,
                                    const std::string& where);

}  // namespace doorforge
