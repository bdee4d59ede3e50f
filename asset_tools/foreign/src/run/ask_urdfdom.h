// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace doorforge::foreign {

/// What the library says of a file: "ok", "no" or "absent", its name with its version, and its
/// words, a line each. To be called in a confined process.
std::string OpinionOfUrdfdom(const std::filesystem::path& file);

}  // namespace doorforge::foreign
