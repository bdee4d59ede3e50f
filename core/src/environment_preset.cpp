// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/environment_preset.h"

#include <algorithm>

#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"
#include "doorforge/core/program.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

fs::path EnvironmentFolder() { return DataFolder() / "environments"; }

}  // namespace

std::vector<std::string> EnvironmentPresets() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(EnvironmentFolder())) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

fs::path EnvironmentPresetFile(const std::string& word) {
  if (word.ends_with(".yaml")) return word;
  const std::vector<std::string> names = EnvironmentPresets();
  if (std::ranges::find(names, word) != names.end()) return EnvironmentFolder() / (word + ".yaml");
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  throw Error(ErrorCode::kInvalidArgument, "--preset " + word + ": did you mean \"" +
                                               NearestName(word, names) + "\"? There are " + all +
                                               ", and files that end with .yaml");
}

}  // namespace doorforge
