// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <vector>

namespace doorforge {

/// The folders of composed doors (with a door.json) at or below each of `folders`, any depth, each
/// once, in the order of their paths. Folders below them whose name begins with a dot are left out:
/// what a killed program left.
///
/// @throws Error(kMissing) that names a folder which does not exist or holds no door.
std::set<std::filesystem::path> FindDoors(const std::vector<std::filesystem::path>& folders);

}  // namespace doorforge
