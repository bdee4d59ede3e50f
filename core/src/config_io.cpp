// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/config_io.h"

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/nearest_name.h"

namespace doorforge {
namespace internal {

void ThrowConfigError(const std::string& path, const std::string& problem) {
  throw Error(ErrorCode::kInvalidConfig, path + ": " + problem);
}

void ThrowUnknownKey(const std::string& path, const std::string& key,
                     const std::vector<std::string>& known) {
  ThrowConfigError(path + "." + key,
                   "unknown key; did you mean \"" + NearestName(key, known) + "\"?");
}

void ThrowUnknownName(const std::string& path, const std::string& name,
                      const std::vector<std::string>& allowed) {
  std::string all;
  for (const std::string& known : allowed) all += (all.empty() ? "" : ", ") + known;
  ThrowConfigError(path, "found \"" + name + "\", allowed " + all + "; did you mean \"" +
                             NearestName(name, allowed) + "\"?");
}

nlohmann::ordered_json Difference(const nlohmann::ordered_json& object,
                                  const nlohmann::ordered_json& from) {
  nlohmann::ordered_json difference = nlohmann::ordered_json::object();
  for (const auto& [key, value] : object.items()) {
    const nlohmann::ordered_json& other = from.at(key);
    if (value == other) continue;
    difference[key] = value.is_object() ? Difference(value, other) : value;
  }
  return difference;
}

}  // namespace internal

void RequireRange(const std::string& path, const char* name, double value, double low,
                  double high) {
  if (value >= low && value <= high) return;
  const auto text = [](double number) { return JsonText(number); };
  internal::ThrowConfigError(
      path + "." + name, "found " + text(value) + ", allowed " + text(low) + " to " + text(high));
}

}  // namespace doorforge
