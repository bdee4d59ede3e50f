// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "doorforge/core/file_system.h"

namespace doorforge {

struct MergeRequest {
  std::filesystem::path folder;  ///< It holds the whole dataset.
  std::vector<std::filesystem::path>
      parts;  ///< Folders of tasks; none where all wrote in `folder`.
  FileSystem* files = &SystemFiles();
};

struct MergeSummary {
  std::uint64_t shards = 0;  ///< The whole dataset has so many.
  std::uint64_t linked = 0;  ///< Brought in as hard links.
  std::uint64_t copied = 0;  ///< Brought in as copies: the part is on another file system.
};

/// Joins the tasks of a collection: brings the shards of `parts` into `folder`, checks that all
/// shards of the plan are there, and writes the records. The parts stay as they are. The bytes are
/// those of a collection by one process. Killed, it goes on where it was.
///
/// @throws Error(kMissing or kFormat) if a part's records cannot be read; Error(kInvalidArgument)
///     if parts are of different configs, doors or builds, or hold one shard with different
///     content, or another process still writes; Error(kIncomplete) that lists missing shards; what
///     was there is merged then, and the same command goes on.
MergeSummary MergeDataset(const MergeRequest& request);

}  // namespace doorforge
