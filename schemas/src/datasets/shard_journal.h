// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/hash.h"
#include "doorforge/schemas/shard.h"

namespace doorforge::internal {

/// Files of a shard that is being written, hidden beside it.
std::filesystem::path PartialTarPath(const std::filesystem::path& folder, int number);
std::filesystem::path JournalPath(const std::filesystem::path& folder, int number);

/// The journal's first line.
std::string JournalHeaderLine(const ShardHeader& header);
/// "<eight hexadecimal digits of the text's CRC-32C> <text>\n"; the text is the JSON on one line.
std::string JournalLine(const nlohmann::ordered_json& entry);

nlohmann::ordered_json JournalEntryOf(const ShardEpisode& episode);
nlohmann::ordered_json JournalEntryOf(const FailedEpisode& failure);

/// The entries of a journal up to the first line that is damaged or cut; the header is the first.
std::vector<nlohmann::ordered_json> JournalEntries(std::string_view journal);

/// What holds of an unfinished shard.
struct RecoveredJournal {
  std::vector<std::string> keys;  ///< They name episodes and failures in order.
  std::vector<ShardEpisode> episodes;
  std::vector<FailedEpisode> failures;
  std::uint64_t journal_bytes = 0;  ///< Length of the lines that hold; 0: not even the first.
  std::uint64_t tar_bytes = 0;      ///< Their episodes take so many in the tar.
  Sha256 hash;                      ///< It runs over these bytes.
};

/// Reads journal and tar up to the first line or episode that is damaged or cut.
///
/// @throws Error(kInvalidArgument) if the journal belongs to a shard with another header.
RecoveredJournal RecoverJournal(const std::filesystem::path& folder, const ShardHeader& header);

}  // namespace doorforge::internal
