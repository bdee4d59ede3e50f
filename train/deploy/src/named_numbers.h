// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/rigid_transform.h"

namespace doorforge::internal {

template <class... Values>
std::string Format(const char* pattern, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

/// Reads a YAML file. Throws Error(kMissing, kInvalidConfig) naming it, also where it is no
/// mapping.
nlohmann::ordered_json ReadNamed(const std::filesystem::path& path);

/// Named numbers of a file; whatever is wrong with one names the file and the key, as
/// Error(kInvalidConfig).
class NamedNumbers {
 public:
  NamedNumbers(std::string file, nlohmann::ordered_json json)
      : file_(std::move(file)), json_(std::move(json)) {}

  /// Throws on a key that is not among these.
  void RequireKnown(const std::vector<std::string>& known) const;
  [[noreturn]] void Fail(const std::string& problem) const;

  const std::string& file() const { return file_; }
  bool Has(const std::string& key) const { return json_.contains(key); }
  const nlohmann::ordered_json& At(const std::string& key) const;
  double Number(const std::string& key, double low, double high) const;
  int WholeNumber(const std::string& key, int low, int high) const;
  bool Flag(const std::string& key) const;
  std::string Word(const std::string& key) const;
  /// Finite numbers, of which there are `least` to `most`.
  std::vector<double> Numbers(const std::string& key, std::size_t least, std::size_t most) const;
  RigidTransform Pose(const std::string& key) const;

 private:
  std::string file_;
  nlohmann::ordered_json json_;
};

}  // namespace doorforge::internal
