// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"

namespace doorforge {

/// Parses YAML (and so JSON). Scalars become booleans, integers, numbers or strings by the YAML 1.2
/// core rules; quoted scalars stay strings; an alias stands for a copy of what it names. Throws
/// Error(kInvalidConfig) with line and column, also where the text means more than 100,000 values
/// or nests deeper than 64 levels: a few aliases can name billions.
nlohmann::ordered_json ParseYaml(std::string_view text, const std::string& name);

/// One nested object from "a.b=c" settings, in order. The value after `=` is YAML.
nlohmann::ordered_json ParseSettings(const std::vector<std::string>& settings);

/// The effective config: defaults <- file (if `path` is not empty) <- `--set a.b=c`. Messages begin
/// with the file, or with "--set".
template <class T>
T LoadConfig(const std::string& path, const std::vector<std::string>& settings, T defaults = {});

/// Gives what `use` gives. Settings are looked at where they are used, far from their file; what is
/// refused there as kInvalidConfig is refused here with the file's name in front, or with "--set"
/// where `path` is empty, unless it begins with the name of another file or an option.
template <class Use>
auto NamingConfig(const std::string& path, Use&& use);

namespace internal {
std::string WithConfigName(const std::string& path, const Error& error);
nlohmann::ordered_json ReadConfigFile(const std::filesystem::path& path);
}  // namespace internal

template <class T>
T LoadConfig(const std::string& path, const std::vector<std::string>& settings, T defaults) {
  T config = std::move(defaults);
  if (!path.empty()) Assign(internal::ReadConfigFile(path), config, path + ": config");
  Assign(ParseSettings(settings), config, "--set: config");
  return config;
}

template <class Use>
auto NamingConfig(const std::string& path, Use&& use) {
  try {
    return use();
  } catch (const Error& error) {
    throw Error(error.code(), internal::WithConfigName(path, error));
  }
}

}  // namespace doorforge
