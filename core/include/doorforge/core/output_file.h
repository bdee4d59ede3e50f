// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace doorforge {

/// Refuses a file that is there, before the work that would replace it: nothing is overwritten
/// unasked. Throws Error(kInvalidArgument), which names the file and --overwrite, if `path` exists
/// and `overwrite` is not set, or if it is a folder; an empty path is no output and is let through.
void RequireNoFile(const std::filesystem::path& path, bool overwrite);

}  // namespace doorforge
