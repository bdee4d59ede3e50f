// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/schemas/episode_arrays.h"
#include "doorforge/schemas/part_identity.h"
#include "doorforge/schemas/shard.h"

namespace doorforge {

inline constexpr int kDatasetSchemaVersion = 1;

/// A dataset is a folder:
///
///     README.md         dataset card
///     dataset.json      features, splits, counts, statistics
///     provenance.json   versions, config hash, seed, doors with their hashes and licences
///     config.yaml       the effective config (JSON, which is YAML)
///     failures.jsonl    every failed episode with its cause
///     splits/<split>.txt              door ids, one a line
///     <stage>/<split>/shard-*.tar     and .index.json
///
/// Everything but the shards is written last and can be rebuilt from them and the plan.
inline constexpr FolderKind kDatasetFolder{"a data set", "config.yaml", "# doorforge "};

/// Episodes of one stage and split.
struct DatasetPart {
  std::string stage;
  std::string split;
  std::uint64_t shards = 0;
  std::uint64_t episodes = 0;
  std::uint64_t failed_episodes = 0;
  std::uint64_t decisions = 0;
  std::uint64_t bytes = 0;  ///< The tars have so many.
};

/// Per component of a feature, over all decisions (for clouds: over all points) of a split.
struct FeatureStatistics {
  std::vector<double> mean;
  std::vector<double> standard_deviation;  ///< It is the population's.
  std::vector<double> minimum;
  std::vector<double> maximum;
};

struct DatasetRecord {
  std::vector<DatasetPart> parts;
  /// They describe the "train" part by feature; empty if it has no episodes.
  std::map<std::string, FeatureStatistics> statistics;
  /// Largest distance of a point from the mean of its cloud in the "train" part [m], the constant
  /// by which networks may scale clouds; 0 if there are no episodes.
  double cloud_radius_m = 0;
  /// Arrays of pictures that the episodes have, sorted by name: those of the first episode of every
  /// shard together.
  std::vector<EpisodeFeature> pictures = {};
};

nlohmann::ordered_json DatasetToJson(const DatasetRecord& record);
/// Throws Error(kFormat).
DatasetRecord DatasetFromJson(const nlohmann::ordered_json& json, const std::string& path);
/// Reads `dataset.json`. Throws Error(kMissing), naming the folder, if there is none.
DatasetRecord ReadDataset(const std::filesystem::path& folder);

/// A door of which episodes were planned.
struct DatasetDoor {
  std::string id;
  std::string sha256;
  std::string category;
  std::string mechanism;
  PartIdentity body;
  PartIdentity handle;
  std::string license;  ///< SPDX expression.
  std::string split;
};

/// What was planned of one stage and split: shard k holds the episodes from k * episodes_per_shard
/// on, the last one what is left.
struct PlannedPart {
  std::string stage;
  std::string split;
  std::uint64_t shards = 0;
  std::uint64_t episodes = 0;  ///< Failed ones included.
  std::uint64_t episodes_per_shard = 0;
};

/// A trained policy that acted in the episodes instead of the rule of its stage.
struct DatasetPolicy {
  std::string stage;           ///< "handle" or "open".
  std::string policy_sha256;   ///< It hashes policy.json.
  std::string weights_sha256;  ///< It hashes the file of the weights.
  std::string dataset_sha256;  ///< The policy was trained from the data with this hash.
  std::string code_version;    ///< This build trained it.
};

nlohmann::ordered_json DatasetPolicyToJson(const DatasetPolicy& policy);

/// Where a dataset came from.
struct DatasetProvenance {
  std::string code_version;
  std::string compiler;
  std::map<std::string, std::string> libraries;  ///< Name to version or setting.
  std::string config_sha256;
  std::uint64_t seed = 0;
  std::vector<DatasetDoor> doors;
  std::vector<PlannedPart> planned = {};     ///< Empty in records of earlier builds.
  std::vector<DatasetPolicy> policies = {};  ///< Empty where the rules did everything.
};

nlohmann::ordered_json ProvenanceToJson(const DatasetProvenance& provenance);
/// Throws Error(kFormat).
DatasetProvenance ProvenanceFromJson(const nlohmann::ordered_json& json, const std::string& path);

/// One line of failures.jsonl, without the newline.
std::string FailureLine(const FailedEpisode& failure, const DatasetPart& part);

/// The generated README.md: YAML front matter (licence, tags), counts, how to read it.
std::string DatasetCard(const DatasetRecord& record, const DatasetProvenance& provenance);

/// Counts and statistics of the shards below `folder`; parts in the order of their names.
/// Throws Error as ShardReader does.
DatasetRecord SummarizeShards(const std::filesystem::path& folder);

/// Index files of a stage's split in ascending order. Throws Error(kMissing) if the folder has no
/// such part.
std::vector<std::filesystem::path> ShardIndices(const std::filesystem::path& folder,
                                                std::string_view stage, std::string_view split);

/// All episodes of a stage's split, in shard order.
class DatasetReader {
 public:
  /// Throws Error as ShardIndices() and ShardReader do.
  DatasetReader(const std::filesystem::path& folder, std::string_view stage, std::string_view split,
                CrcCheck check = CrcCheck::kOnFirstRead);

  std::size_t size() const { return places_.size(); }  ///< Number of episodes.
  const ShardEpisode& entry(std::size_t episode) const;
  EpisodeArrays Arrays(
      std::size_t episode) const;  ///< It does what ViewEpisode() does and is thread-safe.
  std::span<const std::uint8_t> CloudColors(
      std::size_t episode) const;  ///< It does what ViewCloudColors() does and is thread-safe.
  nlohmann::ordered_json Meta(std::size_t episode) const;  ///< It does what ReadEpisodeMeta() does.

  /// ShardReader::RequireWhole() of all shards.
  void RequireWhole() const;

  const std::vector<ShardReader>& shards() const { return shards_; }
  /// Hash over the shards' SHA-256, in order: the identity of what was read.
  std::string ContentHash() const;

 private:
  struct Place {
    std::size_t shard;
    std::size_t episode;
  };

  std::vector<ShardReader> shards_;
  std::vector<Place> places_;
};

}  // namespace doorforge
