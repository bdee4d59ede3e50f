// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/record_id.h"

#include <algorithm>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

namespace doorforge {
namespace {

bool IsLetterOrDigit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

bool IsAllowed(char c) { return IsLetterOrDigit(c) || c == '.' || c == '_' || c == '-'; }

// An id in a message: short, and with nothing in it that a terminal would obey.
std::string Shown(std::string_view id) {
  constexpr std::size_t kMostShown = 60;
  std::string text = JsonText(std::string(id.substr(0, kMostShown)));
  if (id.size() > kMostShown) text += "... (" + std::to_string(id.size()) + " bytes)";
  return text;
}

}  // namespace

std::string IdProblem(std::string_view id) {
  const bool is_fine = !id.empty() && id.size() <= kMaxIdLength &&
                       std::all_of(id.begin(), id.end(), IsAllowed) &&
                       (IsLetterOrDigit(id.front()) || id.front() == '_');
  if (is_fine) return {};
  return "found the id " + Shown(id) + "; allowed are 1 to " + std::to_string(kMaxIdLength) +
         " letters, digits, '.', '_' and '-', the first a letter, a digit or '_'";
}

void RequireId(std::string_view id, const std::string& path) {
  const std::string problem = IdProblem(id);
  if (!problem.empty()) throw Error(ErrorCode::kFormat, path + ": " + problem);
}

std::string IdOf(const nlohmann::ordered_json& json, const std::string& key,
                 const std::string& path) {
  auto id = ValueOf<std::string>(json, key, path);
  RequireId(id, path + "." + key);
  return id;
}

std::filesystem::path OutputBelow(const std::filesystem::path& folder, const std::string& name) {
  const bool is_plain = !name.empty() && name != "." && name != ".." &&
                        name.find('/') == std::string::npos && name.find('\0') == std::string::npos;
  if (!is_plain)
    throw Error(ErrorCode::kFormat, folder.string() + ": " + Shown(name) +
                                        " is no name of a file or folder below it; nothing was "
                                        "written");
  return folder / name;
}

}  // namespace doorforge
