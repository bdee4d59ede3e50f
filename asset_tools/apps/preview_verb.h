// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace doorforge {

/// Draws the door or part in `folder` as `doorforge preview` does and writes the PNG.
void WritePreview(const std::filesystem::path& folder, const std::filesystem::path& png);

/// `doorforge preview PATH... --out FILE.png`. argv[0] is the verb. Returns the exit code.


}  // namespace doorforge
