// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace doorforge::fuzz {

/// Writes an input to a file of this name in a folder that goes with the process, in memory where
/// the system has such a place, and gives the file's path. Files of other names stay.
std::filesystem::path InputFile(const std::string& name, std::string_view bytes);

}  // namespace doorforge::fuzz
