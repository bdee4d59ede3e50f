// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <set>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/shard.h"
#include "doorforge/schemas/tar.h"

#include "shard_names.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void ThrowIo(const fs::path& path, const std::string& what) {
  throw Error(ErrorCode::kIo, path.string() + ": " + what + ": " + std::strerror(errno));
}

// Hidden, beside the shard, and unique within the machine.
fs::path TemporaryPath(const fs::path& folder, int number) {
  static std::atomic<int> count{0};
  return folder / ("." + ShardStem(number) + ".tar.tmp-" + std::to_string(::getpid()) + "-" +
                   std::to_string(count++));
}

void SyncFolder(const fs::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) ThrowIo(folder, "cannot be opened");
  ::fsync(fd);
  ::close(fd);
}

}  // namespace

// The growing tar under its temporary name.
struct ShardWriter::Output {
  explicit Output(fs::path file) : path(std::move(file)) {
    fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (fd < 0) ThrowIo(path, "cannot be created");
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  ~Output() {
    if (fd >= 0) ::close(fd);
    if (!renamed) ::unlink(path.c_str());
  }

  void Append(std::string_view bytes) {
    hash.Update(bytes);
    size += bytes.size();
    while (!bytes.empty()) {
      const ssize_t written = ::write(fd, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) ThrowIo(path, "write failed");
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }

  void Close() {
    if (::fsync(fd) != 0) ThrowIo(path, "fsync failed");
    ::close(fd);
    fd = -1;
  }

  void RenameTo(const fs::path& target) {
    if (::rename(path.c_str(), target.c_str()) != 0) ThrowIo(target, "cannot be put in place");
    renamed = true;
    SyncFolder(target.parent_path());
  }

  fs::path path;
  int fd = -1;
  bool renamed = false;
  std::uint64_t size = 0;
  Sha256 hash;
  std::set<std::string> keys;
};

ShardWriter::ShardWriter(fs::path folder, ShardHeader header) : folder_(std::move(folder)) {
  Require(header.number >= 0 && header.number <= 999999, ErrorCode::kInvalidArgument,
          "shard: number out of 0..999999");
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error)
    throw Error(ErrorCode::kIo, folder_.string() + ": cannot be created: " + error.message());
  index_.tar = ShardStem(header.number) + ".tar";
  output_ = std::make_unique<Output>(TemporaryPath(folder_, header.number));
  index_.header = std::move(header);
}

ShardWriter::~ShardWriter() = default;

void ShardWriter::Add(const std::string& key, std::uint64_t decisions,
                      std::vector<MemberBytes> members) {
  Require(IsKey(key), ErrorCode::kInvalidArgument,
          "shard: key \"" + key + "\" is not letters, digits, '_' and '-'");
  Require(output_->keys.insert(key).second, ErrorCode::kInvalidArgument,
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
  for (std::size_t i = 0; i < members.size(); ++i) {
    output_->Append(MakeTarHeader(key + "." + members[i].name, members[i].bytes.size()));
    episode.members[i].offset = output_->size;
    output_->Append(members[i].bytes);
    output_->Append(std::string(TarPadding(members[i].bytes.size()), '\0'));
  }
  index_.episodes.push_back(std::move(episode));
}

void ShardWriter::AddFailure(FailedEpisode failure) {
  index_.failures.push_back(std::move(failure));
}

ShardCommit ShardWriter::Commit() {
  output_->Append(std::string(kTarEnd, '\0'));
  output_->Close();
  index_.tar_bytes = output_->size;
  index_.tar_sha256 = output_->hash.HexDigest();
  const std::string text = ShardIndexToJson(index_).dump(2) + "\n";
  const fs::path tar_path = folder_ / index_.tar;
  const fs::path index_path = folder_ / (ShardStem(index_.header.number) + ".index.json");
  const auto already_there = [&] {
    if (!fs::exists(index_path)) return false;
    if (ReadFile(index_path) == text && Sha256OfFile(tar_path) == index_.tar_sha256) return true;
    throw Error(ErrorCode::kInvalidArgument,
                index_path.string() +
                    ": already committed with other content; the plan, the "
                    "config or the build differ. Write to another folder");
  };
  if (already_there()) return ShardCommit::kAlreadyThere;
  output_->RenameTo(tar_path);
  try {
    CommitFile(index_path, text, Existing::kRefuse);
  } catch (const Error&) {
    // another writer was faster
    if (already_there()) return ShardCommit::kAlreadyThere;
    throw;
  }
  return ShardCommit::kWritten;
}

}  // namespace doorforge
