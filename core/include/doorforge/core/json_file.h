// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace doorforge {

/// Parses a JSON file of at most 64 MiB. Throws Error(kMissing, kIo or kFormat); the message names
/// the file and, for a syntax error, the byte.
nlohmann::ordered_json ReadJsonFile(const std::filesystem::path& path);

/// Commits `json` with two spaces of indentation and a final newline; key order is kept.
void WriteJsonFile(const std::filesystem::path& path, const nlohmann::ordered_json& json);

/// Checks `schema` and `schema_version` of a record: the name must match and the version must lie
/// in 1..newest. Throws Error(kFormat) that says found against allowed; `path` names the record.
void RequireSchema(const nlohmann::ordered_json& json, const std::string& schema, int newest,
                   const std::string& path);

/// Member access that throws Error(kFormat) naming `path` and the key instead of asserting.
const nlohmann::ordered_json& MemberOf(const nlohmann::ordered_json& json, const std::string& key,
                                       const std::string& path);

/// MemberOf() converted to T; throws Error(kFormat) on the wrong type.
template <class T>
T ValueOf(const nlohmann::ordered_json& json, const std::string& key, const std::string& path);

extern template double ValueOf<double>(const nlohmann::ordered_json&, const std::string&,
                                       const std::string&);
extern template int ValueOf<int>(const nlohmann::ordered_json&, const std::string&,
                                 const std::string&);
extern template bool ValueOf<bool>(const nlohmann::ordered_json&, const std::string&,
                                   const std::string&);
extern template std::uint64_t ValueOf<std::uint64_t>(const nlohmann::ordered_json&,
                                                     const std::string&, const std::string&);
extern template std::string ValueOf<std::string>(const nlohmann::ordered_json&, const std::string&,
                                                 const std::string&);

}  // namespace doorforge
