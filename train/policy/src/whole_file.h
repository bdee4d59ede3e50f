// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/networks/parameters.h"
#include "doorforge/policy/hand_network.h"
#include "doorforge/schemas/safetensors.h"

// What the records of policies of the whole episode have in common.

namespace doorforge::internal {

/// The names of a policy's files.
inline constexpr const char* kWholeWeights = "policy.safetensors";
inline constexpr const char* kWholeRecord = "policy.json";

/// A record, whose `network` is "" where it acts on true states.
struct WholeFile {
  std::string path;
  nlohmann::ordered_json json;
  std::string network;

  nlohmann::ordered_json Member(const char* name) const { return MemberOf(json, name, path); }
  std::string Path(const char* name) const { return path + "." + name; }
};

/// @throws Error(kMissing), Error(kFormat) on the record of another stage.
WholeFile ReadWholeFile(const std::filesystem::path& folder);

/// It is the kind of policy that `network` names; throws Error(kFormat) that says which it is, and
/// how such a one as is needed is made.
void RequireNetwork(const WholeFile& file, const std::string& network);

/// The networks' names for RequireNetwork() and records.
inline constexpr const char* kSightNetwork = "point_net";
inline constexpr const char* kFrozenNetwork = "frozen_point_net";
inline constexpr const char* kTrajectoryNetwork = "trajectories";

/// Settings of a record, checked.
template <class Settings>
Settings SettingsOfRecord(const WholeFile& file, const char* name,
                          void (*check)(const Settings&, const std::string&)) {
  Settings settings;
  try {
    Assign(file.Member(name), settings, file.Path(name));
    check(settings, file.Path(name));
  } catch (const Error& error) {
    throw Error(ErrorCode::kFormat, error.what());
  }
  return settings;
}

nlohmann::ordered_json HandProvenanceToJson(const HandProvenance& provenance);
HandProvenance HandProvenanceFromJson(const nlohmann::ordered_json& json, const std::string& path);

/// The weights that the record names. Throws Error(kFormat) where they are others.
TensorFile ReadWholeWeights(const std::filesystem::path& folder, const WholeFile& file);

/// A network of a policy: its name in the file of weights.
struct NamedParameters {
  const char* name;
  ParameterLayout layout;
  const std::vector<float>& parameters;
};

/// Writes the weights, and begins the record with what says so.
nlohmann::ordered_json WriteWholeWeights(const std::filesystem::path& folder,
                                         std::initializer_list<NamedParameters> networks);

/// Writes the record.
void WriteWholeRecord(const std::filesystem::path& folder, const nlohmann::ordered_json& json);

}  // namespace doorforge::internal
