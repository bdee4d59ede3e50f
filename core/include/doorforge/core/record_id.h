// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace doorforge {

/// The longest id of a record. With the endings and numbers that programs put behind it, a file
/// named by an id stays below the 255 bytes that file systems allow.
inline constexpr std::size_t kMaxIdLength = 120;

/// What is wrong with the id of a door, a part or another record; empty if nothing is.
///
/// Ids name folders and files, and they come from files that anybody may have written. So an id is
/// 1 to 120 ASCII letters, digits, '.', '_' and '-', and begins with a letter, a digit or '_':
/// neither "." nor "..", no hidden name, nothing that a program takes for an option, and one plain
/// component of a path on every system.
std::string IdProblem(std::string_view id);

/// Throws Error(kFormat) "<path>: ..." unless IdProblem() is empty; `path` names the record and,
/// where that helps, the key.
void RequireId(std::string_view id, const std::string& path);

/// ValueOf<std::string>() that has passed RequireId(): how the readers of records take an id.
std::string IdOf(const nlohmann::ordered_json& json, const std::string& key,
                 const std::string& path);

/// `folder / name`, where `name` came from a record. Throws Error(kFormat) unless the name is one
/// plain component, so that nothing is ever written outside the folder that the user named,
/// whatever has been checked before.
std::filesystem::path OutputBelow(const std::filesystem::path& folder, const std::string& name);

}  // namespace doorforge
