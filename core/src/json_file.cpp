// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/json_file.h"

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"

namespace doorforge {

namespace {

using Json = nlohmann::ordered_json;

std::string PlaceIn(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte);
  const std::size_t line = before.rfind('\n');
  const std::size_t column =
      line == std::string_view::npos ? before.size() : before.size() - line - 1;
  return "line " + std::to_string(std::count(before.begin(), before.end(), '\n') + 1) +
         ", column " + std::to_string(column);
}

// Before the text is parsed: the parser's own stack is on the heap, but a value that it has made
// takes a frame of the machine's stack for each level.
void RequireShallow(std::string_view text, const std::string& name) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kMaxJsonDepth)
        throw Error(ErrorCode::kFormat, name + ": " + PlaceIn(text, i + 1) +
                                            ": nested deeper than the " +
                                            std::to_string(kMaxJsonDepth) + " levels allowed");
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
}

}  // namespace

Json ParseJson(std::string_view text, const std::string& name) {
  RequireShallow(text, name);
  // the library takes one for the end of the text, whatever follows
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos)
    throw Error(ErrorCode::kFormat, name + ": not JSON: " + PlaceIn(text, zero + 1));
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw Error(ErrorCode::kFormat, name + ": not JSON: " + PlaceIn(text, error.byte));
  } catch (const Json::exception&) {
    throw Error(ErrorCode::kFormat, name + ": not JSON: a number is too large");
  }
}

Json ReadJsonFile(const std::filesystem::path& path) {
  return ParseJson(ReadFile(path, 64ULL << 20), path.string());
}

std::string JsonText(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

void WriteJsonFile(const std::filesystem::path& path, const Json& json) {
  CommitFile(path, JsonText(json, 2) + "\n");
}

void RequireSchema(const nlohmann::ordered_json& json, const std::string& schema, int newest,
                   const std::string& path) {
  const auto found = ValueOf<std::string>(json, "schema", path);
  const int version = ValueOf<int>(json, "schema_version", path);
  if (found != schema || version < 1 || version > newest)
    throw Error(ErrorCode::kFormat, path + ": schema " + found + " version " +
                                        std::to_string(version) + ", this build reads " + schema +
                                        " up to version " + std::to_string(newest));
}

const nlohmann::ordered_json& MemberOf(const nlohmann::ordered_json& json, const std::string& key,
                                       const std::string& path) {
  if (!json.is_object() || !json.contains(key))
    throw Error(ErrorCode::kFormat, path + ": missing key \"" + key + '"');
  return json.at(key);
}

template <class T>
T ValueOf(const nlohmann::ordered_json& json, const std::string& key, const std::string& path) {
  const nlohmann::ordered_json& member = MemberOf(json, key, path);
  const bool matches = std::is_same_v<T, std::string> ? member.is_string()
                       : std::is_same_v<T, bool>      ? member.is_boolean()
                       : std::is_same_v<T, double>    ? member.is_number()
                                                      : member.is_number_integer();
  if (!matches) throw Error(ErrorCode::kFormat, path + "." + key + ": wrong type");
  if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
    // get<int>() would wrap a number that does not fit
    const bool fits = member.is_number_unsigned() ? std::in_range<T>(member.get<std::uint64_t>())
                                                  : std::in_range<T>(member.get<std::int64_t>());
    if (!fits)
      throw Error(ErrorCode::kFormat,
                  path + "." + key + ": found " + JsonText(member) + ", which is out of range");
  }
  return member.get<T>();
}

template double ValueOf<double>(const nlohmann::ordered_json&, const std::string&,
                                const std::string&);
template int ValueOf<int>(const nlohmann::ordered_json&, const std::string&, const std::string&);
template bool ValueOf<bool>(const nlohmann::ordered_json&, const std::string&, const std::string&);
template std::uint64_t ValueOf<std::uint64_t>(const nlohmann::ordered_json&, const std::string&,
                                              const std::string&);
template std::string ValueOf<std::string>(const nlohmann::ordered_json&, const std::string&,
                                          const std::string&);

}  // namespace doorforge
