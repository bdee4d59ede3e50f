// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "doorforge/authoring/compose_doors.h"

namespace doorforge::internal {

/// The folder that both texts below write to.
inline constexpr const char* kCommandOut = "doors/mine";

/// What a POSIX shell runs to compose the door: what differs from the defaults, as options. Files
/// are looked for in the working directory.
std::string CommandOf(const ComposeRequest& request, const std::filesystem::path& parts);

/// It says the same as a file for `doorforge compose --config`, with the command that reads it in
/// its first line.
std::string YamlOf(const ComposeRequest& request, const std::filesystem::path& parts);

}  // namespace doorforge::internal
