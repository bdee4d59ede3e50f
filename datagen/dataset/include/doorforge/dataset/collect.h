// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/file_system.h"
#include "doorforge/dataset/collection_plan.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/episode.h"

namespace doorforge {

/// What running one planned episode gives.
struct CollectedEpisode {
  Episode episode;
  nlohmann::ordered_json meta;        ///< Record for meta.json, see EncodeEpisode().
  std::string preview_png;            ///< For every episode or for none.
  std::vector<MemberBytes> pictures;  ///< Further arrays, the same names for every episode.
  /// A failure is data as well, as at the stage "grasp": written like a success, unless it has no
  /// decisions or its physics became impossible.
  bool keep_failed = false;
};

/// The episode's members, as EncodeEpisode() and with its pictures. Throws as EncodeEpisode().
std::vector<MemberBytes> MembersOf(const CollectedEpisode& collected);

/// Whether the episode is written into its shard, or else listed among the failures: there as
/// "no_decisions" if the door opened although nobody had anything to decide at the recorded stage,
/// as where closing fingers turn the handle.
bool IsData(const CollectedEpisode& collected);

/// Runs a planned episode. Called from several threads at once; must be a pure function of the
/// plan's entry. An Error that it throws counts as a failed episode with outcome "error", but
/// kMissing, kIo and kFormat, which mean that a door or policy cannot be read at the moment, end
/// the collection: counted, they would make another dataset than the undisturbed one.
using EpisodeRunner = std::function<CollectedEpisode(const PlannedEpisode&)>;

/// A part of the work: the plan's shards k with k mod count == number.
struct CollectionTask {
  int number = 0;  ///< 0..count - 1
  int count = 1;
};

struct CollectRequest {
  std::filesystem::path folder;  ///< The dataset's.
  std::string stage = "open";
  std::string config_text;  ///< Content of config.yaml; its SHA-256 goes into every index.
  /// Without config_sha256 and the doors' splits; all doors of the plan, in its order. Of these the
  /// dataset names those of which it has planned episodes.
  DatasetProvenance provenance;
  int threads = 0;      ///< 0: all processors.
  CollectionTask task;  ///< The whole plan by default.
  FileSystem* files = &SystemFiles();
};

/// Counts over all planned episodes of the task, those kept from an earlier run included.
struct CollectSummary {
  std::uint64_t planned = 0;
  std::uint64_t written = 0;                      ///< Successful episodes.
  std::map<std::string, std::uint64_t> failures;  ///< Outcome to count.
  std::uint64_t shards = 0;
  std::uint64_t kept_shards = 0;    ///< Committed before this run.
  std::uint64_t kept_episodes = 0;  ///< Unfinished shards hold so many, failed ones included.
  std::uint64_t bytes = 0;          ///< All tars together have so many.
  int stopped_by_signal = 0;        ///< Then what was begun is there, and the rest is not.
};

/// Runs the plan's episodes and writes the dataset's folder (see dataset.h).
///
/// Successful episodes go into shards in the plan's order, failed ones with their cause into the
/// shard's index and failures.jsonl. What an earlier run of the same config left is kept: shards
/// that are committed, and of unfinished ones all episodes that are whole (see ShardWriter). The
/// bytes of all files depend only on plan, runner and request: not on threads, tasks, kills or
/// resumes. Memory grows with threads, and by 64 bytes with each planned episode.
///
/// One task of several writes no failures.jsonl, README.md and dataset.json; see MergeDataset().
///
/// @throws Error(kInvalidArgument) if the folder's config.yaml is there and differs from
///     config_text (the message names the settings), or another process writes the same shards;
///     Error(kIo), and what the runner throws as environment's fault; what is committed stays.
CollectSummary Collect(const CollectionPlan& plan, const EpisodeRunner& runner,
                       const CollectRequest& request);

/// What the plan asks of each split, for provenance records.
std::vector<PlannedPart> PlannedParts(const CollectionPlan& plan, const std::string& stage);

}  // namespace doorforge
