// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "doorforge/schemas/shard.h"

namespace doorforge {

/// How far a shard is whose index is not there yet.
struct ShardProgress {
  ShardHeader header;
  std::uint64_t episodes = 0;           ///< Written, so far.
  std::vector<FailedEpisode> failures;  ///< Noted, so far.
  std::uint64_t tar_bytes = 0;
};

/// Looks into the journal of a shard that someone writes or has left unfinished. Takes no lock and
/// opens for reading alone, so that a writer never notices.
///
/// @returns Nothing where no shard of this number was begun, or its index is there by now.
/// @throws Error(kFormat) if an entry is not one of a journal, Error(kIo).
std::optional<ShardProgress> ReadShardProgress(const std::filesystem::path& folder, int number);

/// The journal's path, whose time of change is that of the last episode.
std::filesystem::path ShardJournalPath(const std::filesystem::path& folder, int number);

}  // namespace doorforge
