// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/shard_progress.h"

#include <string>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

#include "datasets/shard_journal.h"
#include "datasets/shard_names.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// A writer that ends takes its files away between any two looks.
std::optional<std::string> TextOf(const fs::path& path) {
  try {
    return ReadFile(path);
  } catch (const Error&) {
    if (fs::exists(path)) throw;
    return std::nullopt;
  }
}

ShardHeader HeaderFrom(const Json& json, const std::string& path) {
  return {ValueOf<int>(json, "number", path), ValueOf<std::string>(json, "stage", path),
          ValueOf<std::string>(json, "split", path),
          ValueOf<std::string>(json, "config_sha256", path)};
}

}  // namespace

fs::path ShardJournalPath(const fs::path& folder, int number) {
  return internal::JournalPath(folder, number);
}

std::optional<ShardProgress> ReadShardProgress(const fs::path& folder, int number) {
  const fs::path path = ShardJournalPath(folder, number);
  const std::optional<std::string> journal = TextOf(path);
  if (!journal || fs::exists(folder / (ShardStem(number) + ".index.json"))) return std::nullopt;
  ShardProgress progress;
  bool is_first = true;
  for (const Json& entry : internal::JournalEntries(*journal)) {
    if (is_first)
      progress.header = HeaderFrom(entry, path.string());
    else if (entry.contains("failure"))
      progress.failures.push_back(FailedEpisodeFromJson(entry["failure"], path.string()));
    else
      ++progress.episodes;
    is_first = false;
  }
  std::error_code gone;
  const std::uintmax_t bytes = fs::file_size(internal::PartialTarPath(folder, number), gone);
  if (!gone) progress.tar_bytes = bytes;
  return progress;
}

}  // namespace doorforge
