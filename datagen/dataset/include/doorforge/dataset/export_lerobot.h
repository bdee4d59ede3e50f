// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "doorforge/core/forwarded_option.h"

namespace doorforge {

/// What doorforge_lerobot.py takes beside the options that all exports have.
std::span<const ForwardedOption> LerobotOptions();

/// Runs python/doorforge_lerobot.py, which writes LeRobot's tables with pyarrow, and returns its
/// exit code; its messages and its answer are the program's. A stop request is passed on to it.
///
/// @param python A path, or a name on $PATH: Python 3.11 or later with numpy and pyarrow.
/// @param folder The dataset's.
/// @param words What the file is called with beside it: "--out", "lerobot".
/// @throws Error(kMissing) if the file or Python is not there, with the way out.
int RunLerobotExport(const std::string& python, const std::filesystem::path& folder,
                     const std::vector<std::string>& words);

}  // namespace doorforge
