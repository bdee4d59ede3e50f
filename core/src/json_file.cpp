// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/json_file.h"

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"

namespace doorforge {

nlohmann::ordered_json ReadJsonFile(const std::filesystem::path& path) {
  const std::string text = ReadFile(path, 64ULL << 20);
  try {
    return nlohmann::ordered_json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::kFormat, path.string() + ": not JSON: " + error.what());
  }
}

void WriteJsonFile(const std::filesystem::path& path, const nlohmann::ordered_json& json) {
  CommitFile(path, json.dump(2) + "\n");
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
