// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/schemas/shard.h"
#include "doorforge/schemas/tar.h"

#include "datasets/shard_journal.h"
#include "datasets/shard_names.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// Bytes that a power cut may take.
constexpr std::uint64_t kSyncEvery = 8ULL << 20;

fs::path IndexPathOf(const fs::path& folder, int number) {
  return folder / (ShardStem(number) + ".index.json");
}

FileLock LockOf(FileSystem& files, const fs::path& journal) {
  std::optional<FileLock> lock = FileLock::Try(files, journal);
  if (!lock)
    throw Error(ErrorCode::kInvalidArgument,
                journal.string() +
                    ": another process is writing this shard; wait for it or stop it, then give "
                    "the same command again");
  return std::move(*lock);
}

// Tar headers, data and padding of an episode. Sets the members' offsets, from `at` on.
std::string TarBytesOf(ShardEpisode& episode, const std::vector<MemberBytes>& members,
                       std::uint64_t at) {
  std::string bytes;
  for (std::size_t i = 0; i < members.size(); ++i) {
    bytes += MakeTarHeader(episode.key + "." + members[i].name, members[i].bytes.size());
    episode.members[i].offset = at + bytes.size();
    bytes += members[i].bytes;
    bytes.append(TarPadding(members[i].bytes.size()), '\0');
  }
  return bytes;
}

}  // namespace

// The growing tar and its journal.
struct ShardWriter::Output {
  Output(FileSystem& file_system, const fs::path& folder, int number, Unfinished what)
      : files(file_system),
        tar_path(internal::PartialTarPath(folder, number)),
        journal_path(internal::JournalPath(folder, number)),
        unfinished(what),
        journal(LockOf(files, journal_path)) {}
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  ~Output() {
    CloseTar();
    if (unfinished == Unfinished::kKeep || is_done) return;
    try {
      RemoveFiles();
    } catch (const Error&) {
      return;  // the next writer discards them
    }
  }

  void CloseTar() {
    if (tar >= 0) files.Close(tar);
    tar = -1;
  }

  // Cuts both files to what holds.
  void Begin(const ShardHeader& header, const internal::RecoveredJournal& found) {
    tar = files.OpenToAppend(tar_path);
    files.Truncate(tar, found.tar_bytes, tar_path);
    files.Truncate(journal.file(), found.journal_bytes, journal_path);
    if (found.journal_bytes == 0) {
      WriteAll(files, journal.file(), internal::JournalHeaderLine(header), journal_path);
      files.SyncFolder(tar_path.parent_path());
    }
    size = found.tar_bytes;
  }

  void Append(std::string_view bytes) {
    WriteAll(files, tar, bytes, tar_path);
    hash.Update(bytes);
    size += bytes.size();
  }

  void Note(const std::string& line) {
    WriteAll(files, journal.file(), line, journal_path);
    if (size - synced < kSyncEvery) return;
    files.Sync(tar, tar_path);
    files.Sync(journal.file(), journal_path);
    synced = size;
  }

  // The journal last: without it there is nothing to go on with.
  void RemoveFiles() {
    files.Remove(tar_path);
    files.Remove(journal_path);
  }

  FileSystem& files;
  fs::path tar_path;
  fs::path journal_path;
  Unfinished unfinished;
  FileLock journal;
  int tar = -1;
  std::uint64_t size = 0;
  std::uint64_t synced = 0;
  Sha256 hash;
  std::set<std::string> keys;
  bool is_writing = false;  // stays set when a write fails: the files' ends are not known then
  bool is_done = false;
};

ShardWriter::ShardWriter(fs::path folder, ShardHeader header, Unfinished unfinished,
                         FileSystem& files)
    : folder_(std::move(folder)) {
  Require(header.number >= 0 && header.number <= 999999, ErrorCode::kInvalidArgument,
          "shard: number out of 0..999999");
  files.CreateFolder(folder_);
  index_.tar = ShardStem(header.number) + ".tar";
  index_.header = std::move(header);
  const int number = index_.header.number;
  output_ = std::make_unique<Output>(files, folder_, number, unfinished);
  internal::RecoveredJournal found;
  if (unfinished == Unfinished::kKeep) {
    // a tar that was put in place without its index is unfinished
    if (!fs::exists(IndexPathOf(folder_, number)) && !fs::exists(output_->tar_path) &&
        fs::exists(folder_ / index_.tar))
      files.Rename(folder_ / index_.tar, output_->tar_path);
    found = internal::RecoverJournal(folder_, index_.header);
  }
  output_->Begin(index_.header, found);
  output_->hash = std::move(found.hash);
  output_->keys.insert(found.keys.begin(), found.keys.end());
  keys_ = std::move(found.keys);
  index_.episodes = std::move(found.episodes);
  index_.failures = std::move(found.failures);
}

ShardWriter::~ShardWriter() = default;

void ShardWriter::Note(const std::string& key, const nlohmann::ordered_json& entry) {
  output_->Note(internal::JournalLine(entry));
  output_->keys.insert(key);
  keys_.push_back(key);
  output_->is_writing = false;
}

void ShardWriter::Add(const std::string& key, std::uint64_t decisions,
                      std::vector<MemberBytes> members) {
  Require(!output_->is_writing, ErrorCode::kInvalidArgument,
          "shard: takes nothing more after a failed write");
  Require(IsKey(key), ErrorCode::kInvalidArgument,
          "shard: key \"" + key + "\" is not letters, digits, '_' and '-'");
  Require(output_->keys.count(key) == 0, ErrorCode::kInvalidArgument,
          "shard: key \"" + key + "\" was there before");
  std::sort(members.begin(), members.end(),
            [](const MemberBytes& a, const MemberBytes& b) { return a.name < b.name; });
  ShardEpisode episode{key, decisions, {}};
  for (const MemberBytes& member : members) {
    Require(IsMemberName(member.name), ErrorCode::kInvalidArgument,
            "shard: bad member name \"" + member.name + '"');
    episode.members.push_back(
        {member.name, 0, member.bytes.size(), Crc32c(std::as_bytes(std::span(member.bytes)))});
  }
  Require(index_.episodes.empty() || SameMembers(index_.episodes[0], episode),
          ErrorCode::kInvalidArgument,
          "shard: " + key + " has other members than the episodes before it");
  const std::string bytes = TarBytesOf(episode, members, output_->size);
  output_->is_writing = true;
  output_->Append(bytes);
  Note(key, internal::JournalEntryOf(episode));
  index_.episodes.push_back(std::move(episode));
}

void ShardWriter::AddFailure(FailedEpisode failure) {
  Require(!output_->is_writing, ErrorCode::kInvalidArgument,
          "shard: takes nothing more after a failed write");
  output_->is_writing = true;
  Note(failure.key, internal::JournalEntryOf(failure));
  index_.failures.push_back(std::move(failure));
}

ShardCommit ShardWriter::Commit() {
  Require(!output_->is_writing, ErrorCode::kInvalidArgument,
          "shard: takes nothing more after a failed write");
  output_->is_writing = true;
  FileSystem& files = output_->files;
  output_->Append(std::string(kTarEnd, '\0'));
  files.Sync(output_->tar, output_->tar_path);
  output_->CloseTar();
  index_.tar_bytes = output_->size;
  index_.tar_sha256 = output_->hash.HexDigest();
  const std::string text = ShardIndexText(index_);
  const fs::path tar_path = folder_ / index_.tar;
  const fs::path index_path = IndexPathOf(folder_, index_.header.number);
  if (fs::exists(index_path)) {
    if (ReadFile(index_path) != text || Sha256OfFile(tar_path) != index_.tar_sha256)
      throw Error(ErrorCode::kInvalidArgument,
                  index_path.string() +
                      ": already committed with other content; the plan, the "
                      "config or the build differ. Write to another folder");
    output_->RemoveFiles();
    output_->is_done = true;
    return ShardCommit::kAlreadyThere;
  }
  files.Rename(output_->tar_path, tar_path);
  files.SyncFolder(folder_);
  CommitFile(files, index_path, text, Existing::kRefuse);
  output_->RemoveFiles();
  output_->is_done = true;
  return ShardCommit::kWritten;
}

bool HasShardLeftovers(const fs::path& folder, int number) {
  return fs::exists(internal::JournalPath(folder, number)) ||
         fs::exists(internal::PartialTarPath(folder, number)) ||
         (fs::exists(folder / (ShardStem(number) + ".tar")) &&
          !fs::exists(IndexPathOf(folder, number)));
}

void RemoveShardLeftovers(FileSystem& files, const fs::path& folder, int number) {
  const fs::path journal = internal::JournalPath(folder, number);
  const fs::path tar = internal::PartialTarPath(folder, number);
  if (!fs::exists(journal) && !fs::exists(tar)) return;
  const std::optional<FileLock> lock = FileLock::Try(files, journal);
  if (!lock) return;
  files.Remove(tar);
  files.Remove(journal);
}

}  // namespace doorforge
