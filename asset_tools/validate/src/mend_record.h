// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "doorforge/validate/fix_door.h"

#include "findings.h"

namespace doorforge::internal {

/// Mend the fixable ones of `findings` in a folder that nobody else looks at yet. What cannot be
/// mended is left out of the result. Throw as ReadDoor() and ReadPart() do.
std::vector<Fix> MendDoor(const std::filesystem::path& folder, const Findings& findings);
std::vector<Fix> MendPart(const std::filesystem::path& folder, const Findings& findings);

}  // namespace doorforge::internal
