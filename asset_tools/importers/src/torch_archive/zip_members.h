// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace doorforge::internal {

/// The stored members of a ZIP archive, by name; views into `bytes`.
///
/// PKWARE APPNOTE 6.3: the central directory is read; of archives below 4 GiB, so without 64-bit
/// sizes. Throws Error(kFormat), naming `name`, on compressed or encrypted members, members outside
/// the archive, or no directory.
std::map<std::string, std::string_view> ZipMembers(std::string_view bytes, const std::string& name);

}  // namespace doorforge::internal
