// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "doorforge/core/file_system.h"
#include "doorforge/schemas/dataset.h"

namespace doorforge {

/// Names of a dataset's records, from its folder.
inline constexpr const char* kConfigRecord = "config.yaml";
inline constexpr const char* kProvenanceRecord = "provenance.json";
inline constexpr const char* kFailuresRecord = "failures.jsonl";
inline constexpr const char* kReadmeRecord = "README.md";
inline constexpr const char* kCroissantRecord =
    "croissant.json";  ///< `dataset card` alone writes it.
inline constexpr const char* kDatasetRecord = "dataset.json";

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

/// Reads provenance.json. Throws Error(kMissing or kFormat), also if it is not the one that
/// SHA256SUMS lists.
DatasetProvenance ReadProvenance(const std::filesystem::path& folder);

/// The splits that have a file of their own, "splits/<name>.txt".
inline constexpr std::array<const char*, 2> kSplitNames = {"train", "val"};
/// "splits/train.txt"
std::string SplitRecord(const std::string& split);

/// What the records hold as writers make them from provenance, indices and shards.
std::string SplitText(const DatasetProvenance& provenance, const std::string& split);
std::string FailuresText(std::span<const ShardIndex> indices);
std::string DatasetText(const DatasetRecord& record);
std::string ProvenanceText(const DatasetProvenance& provenance);
/// Returns the same content as the builds before wrote it, with each number on a line of its own.
std::string EarlierProvenanceText(const DatasetProvenance& provenance);
/// README.md as FinishDataset() writes it, and as the builds before did.
std::set<std::string> ShortCards(const DatasetRecord& record, const DatasetProvenance& provenance);

/// What is known before the first episode: config.yaml, provenance.json, splits/*.txt, and their
/// lines of SHA256SUMS. Several processes may do so at once.
///
/// @throws Error(kInvalidArgument) if the folder's config.yaml is another one, Error(kIo).
void BeginDataset(FileSystem& files, const std::filesystem::path& folder,
                  const std::string& config_text, const DatasetProvenance& provenance);

/// What the shards say: failures.jsonl, README.md, SHA256SUMS and, last, dataset.json, whose
/// presence means that the dataset is complete. A README.md that is there already stays: it is this
/// one, that of `dataset card`, or a user's.
///
/// @throws Error(kIncomplete) that lists the planned shards which are missing or short.
void FinishDataset(FileSystem& files, const std::filesystem::path& folder);

}  // namespace doorforge
