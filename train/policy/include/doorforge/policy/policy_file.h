// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "doorforge/networks/stage_networks.h"
#include "doorforge/policy/train_config.h"
#include "doorforge/schemas/seen_parts.h"

namespace doorforge {

inline constexpr int kPolicySchemaVersion = 1;

/// What a policy was made from.
struct PolicyProvenance {
  std::string stage;           ///< "open", "handle", "grasp", "motion" or "find".
  std::string dataset_sha256;  ///< StageDataset::content_sha256 of what it was trained from.
  std::string code_version;
  TrainConfig config;
  std::uint64_t step = 0;
  std::string from_weights_sha256 = {};  ///< The policy began with these weights; empty: with none.
  SeenParts trained_on = {};             ///< Empty in records of earlier builds.
  BestEpochs best = {};  ///< The networks are those of these epochs; all 0: of the last.
};

/// The record of a policy's folder, docs/format-policy.md.
struct PolicyRecord {
  PolicyProvenance provenance;
  std::string weights_sha256;  ///< It hashes policy.safetensors.
  StageNetworks networks;
};

/// SHA-256 of the effective config's JSON text.
std::string ConfigHash(const TrainConfig& config);

/// Writes `policy.safetensors` (every weight in half precision under its layer's name, after the
/// network's, see NetworkNames) and then `policy.json` (schema doorforge.policy: sizes,
/// normalisation, provenance and the weights' SHA-256). Equal arguments give equal bytes.
void WritePolicy(const std::filesystem::path& folder, const StageNetworks& networks,
                 const PolicyProvenance& provenance);

/// Throws Error(kMissing), Error(kFormat) on a damaged record, one of another stage, or weights
/// that do not belong to it. One of kMotionStage serves at both stages that it was trained for.
PolicyRecord ReadPolicy(const std::filesystem::path& folder, std::string_view stage = "open");

}  // namespace doorforge
