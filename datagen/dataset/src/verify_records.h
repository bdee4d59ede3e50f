// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <iterator>
#include <utility>
#include <vector>

#include "doorforge/dataset/verify_dataset.h"

namespace doorforge::internal {

using Findings = std::vector<DatasetFinding>;

inline void Append(Findings& to, Findings from) {
  std::move(from.begin(), from.end(), std::back_inserter(to));
}

/// What is wrong with a dataset's records, and which files are no part of it.
///
/// @param indices Of the shards below `folder`, in ascending order; those that cannot be read are
///     left out.
/// @param shards_are_whole Whether the shards had no findings, so that the statistics of
///     dataset.json can be made from them again.
Findings CheckRecords(const std::filesystem::path& folder,
                      const std::vector<std::filesystem::path>& indices, bool shards_are_whole);

}  // namespace doorforge::internal
