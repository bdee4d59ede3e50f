// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/core/file_system.h"
#include "doorforge/schemas/dataset.h"

namespace doorforge {

/// A shard that the plan of a dataset has.
struct ExpectedShard {
  std::string stage;
  std::string split;
  int number = 0;
  std::uint64_t episodes = 0;  ///< Failed ones included.

  /// "open/train/shard-000003"
  std::string Name() const;
};

/// In the plan's order.
std::vector<ExpectedShard> ExpectedShards(const DatasetProvenance& provenance);

/// What is wrong with a planned shard: missing, of another config, or of another number of
/// episodes; empty if nothing is. Throws as ReadShardIndex().
std::string PlanFaultOf(const std::filesystem::path& folder, const ExpectedShard& shard,
                        const std::string& config_sha256);

/// Reads provenance.json. Throws Error(kMissing or kFormat).
DatasetProvenance ReadProvenance(const std::filesystem::path& folder);

/// What is known before the first episode: config.yaml, provenance.json and splits/*.txt. Several
/// processes may do so at once.
///
/// @throws Error(kInvalidArgument) if the folder's config.yaml is another one, Error(kIo).
void BeginDataset(FileSystem& files, const std::filesystem::path& folder,
                  const std::string& config_text, const DatasetProvenance& provenance);

/// What the shards say: failures.jsonl, README.md and, last, dataset.json, whose presence means
/// that the dataset is complete.
///
/// @throws Error(kIncomplete) that lists the planned shards which are missing or short.
void FinishDataset(FileSystem& files, const std::filesystem::path& folder);

}  // namespace doorforge
