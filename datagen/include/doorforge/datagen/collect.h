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

#include "doorforge/datagen/collection_plan.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/episode.h"

namespace doorforge {

/// What running one planned episode gives.
struct CollectedEpisode {
  Episode episode;
  nlohmann::ordered_json meta;  ///< Record for meta.json, see EncodeEpisode().
  std::string preview_png;      ///< For every episode or for none.
};

/// Runs a planned episode. Called from several threads at once; must be a pure function of the
/// plan's entry. What it throws as Error counts as a failed episode with outcome "error".
using EpisodeRunner = std::function<CollectedEpisode(const PlannedEpisode&)>;

struct CollectRequest {
  std::filesystem::path folder;  ///< The dataset's.
  std::string stage = "open";
  std::string config_text;       ///< Content of config.yaml; its SHA-256 goes into every index.
  DatasetProvenance provenance;  ///< Without config_sha256 and the doors' splits.
  int threads = 0;               ///< 0: all processors.
};

/// Counts over all planned episodes, those kept from an earlier run included.
struct CollectSummary {
  std::uint64_t planned = 0;
  std::uint64_t written = 0;                      ///< Successful episodes.
  std::map<std::string, std::uint64_t> failures;  ///< Outcome to count.
  std::uint64_t kept_shards = 0;                  ///< Committed before this run.
  std::uint64_t bytes = 0;                        ///< Of all tars.
  int stopped_by_signal = 0;                      ///< Then only the committed shards are there.
};

/// Runs the plan's episodes and writes the dataset's folder (see dataset.h).
///
/// Successful episodes go into shards in the plan's order, failed ones with their cause into the
/// shard's index and failures.jsonl. Shards that are committed already are kept as they are. The
/// bytes of all files depend only on plan, runner and request: not on threads, kills or resumes.
/// Memory grows with threads, not with episodes.
///
/// @throws Error(kInvalidArgument) if the folder's config.yaml is there and differs from
///     config_text (two lines show where), Error(kIo).
CollectSummary Collect(const CollectionPlan& plan, const EpisodeRunner& runner,
                       const CollectRequest& request);

/// Removes temporary files that dead writers of this machine left in a dataset's folder.
void RemoveStaleFiles(const std::filesystem::path& folder);

}  // namespace doorforge
