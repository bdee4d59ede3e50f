// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/core/config_file.h"

namespace doorforge {

/// The names of the environments in data/environments, in the order of the alphabet. Each is a file
/// of settings with the keys "scene" and "cloud"; docs/environment.md has the table.
std::vector<std::string> EnvironmentPresets();

/// The file that a word for an environment means: one of the names, or a path that ends with
/// ".yaml".
///
/// @throws Error(kInvalidArgument) on another word, with the nearest name and all there are.
std::filesystem::path EnvironmentPresetFile(const std::string& word);

/// The places that a verb's settings come from, each over those before it.
struct ConfigSources {
  std::string preset;                 ///< Word for EnvironmentPresetFile(); empty: none.
  std::string file;                   ///< The user's own settings lie there; empty: none.
  std::vector<std::string> settings;  ///< "a.b=c".
  std::string simulator = {};  ///< Value of scene.physics.simulator; empty: as the others say.

  /// The file that NamingConfig() is to name: the last there is.
  std::string Named() const {
    return !file.empty() || preset.empty() ? file : EnvironmentPresetFile(preset).string();
  }
};

/// The effective config: defaults <- preset <- file <- simulator <- settings. Throws as
/// EnvironmentPresetFile() and as the LoadConfig() of one file.
template <class T>
T LoadConfig(const ConfigSources& sources, T defaults = {}) {
  if (!sources.preset.empty())
    defaults = LoadConfig(EnvironmentPresetFile(sources.preset).string(), {}, std::move(defaults));
  std::vector<std::string> settings = sources.settings;
  if (!sources.simulator.empty())
    settings.insert(settings.begin(), "scene.physics.simulator=" + sources.simulator);
  return LoadConfig(sources.file, settings, std::move(defaults));
}

}  // namespace doorforge
