// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace doorforge {

/// The deepest nesting of arrays and objects that is read: a record has five levels. A deeper text
/// would end the process where it is copied or destroyed, level by level, on the stack.
inline constexpr int kMaxJsonDepth = 64;

/// The only reader of JSON from outside. Throws Error(kFormat) "<name>: not JSON: line 3, column 7"
/// on a syntax error, on text that is no UTF-8, on a number that no double holds, and, with the
/// line, where it is nested deeper than kMaxJsonDepth.
nlohmann::ordered_json ParseJson(std::string_view text, const std::string& name);

/// Parses a JSON file of at most 64 MiB. Throws Error(kMissing or kIo), and as ParseJson() with the
/// file's path.
nlohmann::ordered_json ReadJsonFile(const std::filesystem::path& path);

/// The only writer of JSON: the text of `json`, on one line or with `indent` spaces a level. Bytes
/// of strings that are no UTF-8, as names of files may hold, become U+FFFD, so that a document is
/// always JSON; valid text is kept byte for byte. Does not throw.
std::string JsonText(const nlohmann::ordered_json& json, int indent = -1);

/// Commits `json` with two spaces of indentation and a final newline; key order is kept.
void WriteJsonFile(const std::filesystem::path& path, const nlohmann::ordered_json& json);

/// Checks `schema` and `schema_version` of a record: the name must match and the version must lie
/// in 1..newest. Throws Error(kFormat) that says found against allowed; `path` names the record.
void RequireSchema(const nlohmann::ordered_json& json, const std::string& schema, int newest,
                   const std::string& path);

/// Member access that throws Error(kFormat) naming `path` and the key instead of asserting.
const nlohmann::ordered_json& MemberOf(const nlohmann::ordered_json& json, const std::string& key,
                                       const std::string& path);

/// MemberOf() converted to T; throws Error(kFormat) on the wrong type, and on an integer that T
/// does not hold.
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
