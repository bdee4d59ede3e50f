// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/dataset/collect.h"
#include "doorforge/dataset/verify_dataset.h"

namespace doorforge {

struct RegenerateRequest {
  std::filesystem::path folder;  ///< The dataset's.
  std::string stage = "open";
  double fraction =
      0.01;         ///< This share of the planned episodes, in (0, 1], is made again; at least one.
  int threads = 0;  ///< 0: all processors.
};

struct RegenerateResult {
  std::size_t episodes = 0;  ///< Made again.
  std::vector<DatasetFinding> findings;
};

/// Makes some episodes again from their seeds and compares every byte of every member, or the cause
/// of failure, with what the dataset holds. They are drawn over the whole plan, the same in every
/// run. Each difference is a finding DST011, whatever the threads.
///
/// @throws Error(kInvalidArgument) if the fraction is out of range, and as ShardReader.
RegenerateResult RegenerateEpisodes(const CollectionPlan& plan, const EpisodeRunner& runner,
                                    const RegenerateRequest& request);

/// "1%" or "0.01" as 0.01. Throws Error(kInvalidArgument) unless in (0, 1].
double ParseFraction(const std::string& text);

}  // namespace doorforge
