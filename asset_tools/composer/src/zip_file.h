// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace doorforge::internal {

struct ZipMember {
  std::string name;  ///< With slashes, relative.
  std::string bytes;
};

/// A ZIP file (APPNOTE.TXT 6.3) with the members as they are, not compressed, dated 1980-01-01:
/// equal members give equal bytes. Throws Error(kInvalidArgument) where it would take 4 GiB or
/// 65,535 members.
std::string ZipOf(const std::vector<ZipMember>& members);

/// All files below a folder, sorted by their names, which begin with `top` and a slash.
std::vector<ZipMember> MembersOf(const std::filesystem::path& folder, const std::string& top);

/// CRC-32 of ISO 3309, as ZIP has it.
std::uint32_t Crc32(std::string_view bytes);

}  // namespace doorforge::internal
