// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "datasets/shard_journal.h"

#include <cstdio>
#include <optional>
#include <span>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/tar.h"

#include "datasets/mapped_file.h"
#include "datasets/shard_names.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kCrcDigits = 8;

std::string CrcText(std::string_view text) {
  char digits[kCrcDigits + 1];
  std::snprintf(digits, sizeof digits, "%08x", Crc32c(std::as_bytes(std::span(text))));
  return digits;
}

// The line that begins at `at`, without its newline; nothing if it is cut or damaged.
std::optional<Json> EntryAt(std::string_view journal, std::uint64_t at) {
  const std::size_t end = journal.find('\n', at);
  if (end == std::string_view::npos || end < at + kCrcDigits + 1) return std::nullopt;
  const std::string_view text = journal.substr(at + kCrcDigits + 1, end - at - kCrcDigits - 1);
  if (journal.substr(at, kCrcDigits + 1) != CrcText(text) + " ") return std::nullopt;
  try {
    Json entry = ParseJson(text, "journal");
    if (entry.is_object()) return entry;
  } catch (const Error&) {
    // a damaged end of a journal is what it is read for
  }
  return std::nullopt;
}

// Whether the tar has this episode at `at`, whole; `at` moves behind it.
class TarWalk {
 public:
  explicit TarWalk(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool Take(const ShardEpisode& episode) {
    std::uint64_t at = at_;
    for (const ShardMember& member : episode.members) {
      const std::string header = MakeTarHeader(episode.key + "." + member.name, member.size);
      const std::uint64_t padding = TarPadding(member.size);
      if (member.offset != at + kTarBlock || member.offset > bytes_.size() ||
          member.size > bytes_.size() - member.offset ||
          padding > bytes_.size() - member.offset - member.size)
        return false;
      const auto data = bytes_.subspan(member.offset, member.size);
      if (TextAt(at, kTarBlock) != header || Crc32c(data) != member.crc32c) return false;
      if (TextAt(member.offset + member.size, padding).find_first_not_of('\0') !=
          std::string_view::npos)
        return false;
      at = member.offset + member.size + padding;
    }
    at_ = at;
    return true;
  }

  std::uint64_t at() const { return at_; }

 private:
  std::string_view TextAt(std::uint64_t at, std::uint64_t size) const {
    return {reinterpret_cast<const char*>(bytes_.data()) + at, size};
  }

  std::span<const std::byte> bytes_;
  std::uint64_t at_ = 0;
};

// False if the entry does not hold.
bool TakeEntry(const Json& entry, const std::string& path, TarWalk& tar, RecoveredJournal& found) {
  if (entry.contains("failure")) {
    found.failures.push_back(FailedEpisodeFromJson(entry["failure"], path));
    found.keys.push_back(found.failures.back().key);
    return true;
  }
  ShardEpisode episode = ShardEpisodeFromJson(MemberOf(entry, "episode", path), path);
  if (!tar.Take(episode)) return false;
  found.keys.push_back(episode.key);
  found.episodes.push_back(std::move(episode));
  return true;
}

RecoveredJournal Recover(std::string_view journal, std::span<const std::byte> tar_bytes,
                         const ShardHeader& header, const std::string& path) {
  RecoveredJournal found;
  const std::optional<Json> first = EntryAt(journal, 0);
  if (!first) return found;
  const std::string expected = JournalHeaderLine(header);
  if (!journal.starts_with(expected))
    throw Error(ErrorCode::kInvalidArgument,
                path +
                    ": a shard was begun here with another config; remove the file and the "
                    ".partial beside it, or write to another folder");
  found.journal_bytes = expected.size();
  TarWalk tar(tar_bytes);
  while (const std::optional<Json> entry = EntryAt(journal, found.journal_bytes)) {
    if (!TakeEntry(*entry, path, tar, found)) break;
    found.journal_bytes = journal.find('\n', found.journal_bytes) + 1;
  }
  found.tar_bytes = tar.at();
  found.hash.Update(tar_bytes.first(found.tar_bytes));
  return found;
}

}  // namespace

fs::path PartialTarPath(const fs::path& folder, int number) {
  return folder / ("." + ShardStem(number) + ".tar.partial");
}

fs::path JournalPath(const fs::path& folder, int number) {
  return folder / ("." + ShardStem(number) + ".journal");
}

std::string JournalLine(const Json& entry) {
  const std::string text = JsonText(entry);
  return CrcText(text) + " " + text + "\n";
}

std::string JournalHeaderLine(const ShardHeader& header) {
  return JournalLine({{"schema", "doorforge.shard_journal"},
                      {"schema_version", kShardSchemaVersion},
                      {"number", header.number},
                      {"stage", header.stage},
                      {"split", header.split},
                      {"config_sha256", header.config_sha256}});
}

Json JournalEntryOf(const ShardEpisode& episode) {
  return {{"episode", ShardEpisodeToJson(episode)}};
}

Json JournalEntryOf(const FailedEpisode& failure) {
  return {{"failure", FailedEpisodeToJson(failure)}};
}

std::vector<Json> JournalEntries(std::string_view journal) {
  std::vector<Json> entries;
  std::uint64_t at = 0;
  while (std::optional<Json> entry = EntryAt(journal, at)) {
    entries.push_back(std::move(*entry));
    at = journal.find('\n', at) + 1;
  }
  return entries;
}

RecoveredJournal RecoverJournal(const fs::path& folder, const ShardHeader& header) {
  const fs::path path = JournalPath(folder, header.number);
  const fs::path tar = PartialTarPath(folder, header.number);
  const std::string journal = fs::exists(path) ? ReadFile(path) : std::string();
  if (!fs::exists(tar)) return Recover(journal, {}, header, path.string());
  const MappedFile mapped(tar);
  RecoveredJournal recovered = Recover(journal, mapped.bytes(), header, path.string());
  mapped.RequireWhole();
  return recovered;
}

}  // namespace doorforge::internal
