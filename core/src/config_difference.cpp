// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/config_difference.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <vector>

#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;
using Lines = std::vector<std::string>;

constexpr std::size_t kMostLines = 20;
constexpr std::size_t kMostCharacters = 200;  // of a line
constexpr const char* kNone = "none";

// A config's comments, or what is between them.
Lines LinesOf(const std::string& text, bool comments) {
  Lines lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with('#') == comments) lines.push_back(line);
  return lines;
}

void CompareLines(const Lines& recorded, const Lines& given, Lines& differences) {
  const auto line = [](const Lines& lines, std::size_t i) {
    return i < lines.size() ? lines[i] : std::string(kNone);
  };
  for (std::size_t i = 0; i < std::max(recorded.size(), given.size()); ++i) {
    if (line(recorded, i) == line(given, i)) continue;
    differences.push_back("recorded: " + line(recorded, i));
    differences.push_back("given:    " + line(given, i));
  }
}

const Json* Find(const Json& object, const std::string& key) {
  const auto entry = object.find(key);
  return entry == object.end() ? nullptr : &*entry;
}

std::string ValueText(const Json* value) { return value == nullptr ? kNone : JsonText(*value); }

void CompareObjects(const Json& recorded, const Json& given, const std::string& path,
                    Lines& differences) {
  std::vector<std::string> keys;
  for (const auto& [key, unused] : recorded.items()) keys.push_back(key);
  for (const auto& [key, unused] : given.items())
    if (!recorded.contains(key)) keys.push_back(key);
  for (const std::string& key : keys) {
    const Json* there = Find(recorded, key);
    const Json* here = Find(given, key);
    if (there != nullptr && here != nullptr && *there == *here) continue;
    if (there != nullptr && here != nullptr && there->is_object() && here->is_object())
      CompareObjects(*there, *here, path + key + ".", differences);
    else
      differences.push_back(path + key + ": recorded " + ValueText(there) + ", given " +
                            ValueText(here));
  }
}

std::optional<Json> SettingsIn(const std::string& text) {
  try {
    Json settings = ParseYaml(text, "config");
    if (settings.is_object()) return settings;
  } catch (const Error&) {  // then its lines are all that there is to compare
  }
  return std::nullopt;
}

}  // namespace

std::string ConfigDifference(const std::string& recorded, const std::string& given) {
  Lines differences;
  CompareLines(LinesOf(recorded, true), LinesOf(given, true), differences);
  const auto there = SettingsIn(recorded);
  const auto here = SettingsIn(given);
  if (there && here)
    CompareObjects(*there, *here, "", differences);
  else
    CompareLines(LinesOf(recorded, false), LinesOf(given, false), differences);
  std::string text;
  for (std::size_t i = 0; i < std::min(differences.size(), kMostLines); ++i) {
    const std::string& line = differences[i];
    text += "\n  " + line.substr(0, kMostCharacters);
    if (line.size() > kMostCharacters) text += "...";
  }
  if (differences.size() > kMostLines)
    text += "\n  and " + std::to_string(differences.size() - kMostLines) + " lines more";
  return text;
}

}  // namespace doorforge
