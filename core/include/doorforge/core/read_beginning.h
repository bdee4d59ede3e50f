// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace doorforge {

/// The first bytes of a file, fewer where it is shorter, none where it is no regular file or cannot
/// be read: for telling what it is. It never waits for a pipe.
std::string ReadBeginning(const std::filesystem::path& path, std::uint64_t bytes);

}  // namespace doorforge
