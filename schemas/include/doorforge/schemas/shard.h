// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/core/file_system.h"

namespace doorforge {

inline constexpr int kShardSchemaVersion = 1;

/// A shard is `shard-NNNNNN.tar` in WebDataset naming (members "<key>.<name>", a key's members side
/// by side) and `shard-NNNNNN.index.json`, whose presence means that the shard is complete. The
/// format is specified in docs/format-shards.md.

/// A member as it is handed to the writer. Names hold the extension: "cloud.npy", "meta.json".
struct MemberBytes {
  std::string name;
  std::string bytes;
};

/// Where a member lies in the tar.
struct ShardMember {
  std::string name;
  std::uint64_t offset = 0;  ///< The data begin there in the tar, at a multiple of 512.
  std::uint64_t size = 0;    ///< [bytes]
  std::uint32_t crc32c = 0;  ///< It is computed over the data.
};

struct ShardEpisode {
  std::string key;                   ///< Without dots, unique in the shard.
  std::uint64_t decisions = 0;       ///< Length of the arrays' leading axis.
  std::vector<ShardMember> members;  ///< Sorted by name; the same names for every key.
};

/// An episode of the shard's part of the plan that was not written, and why.
struct FailedEpisode {
  std::string key;
  std::string door_id;
  std::string outcome;  ///< NameOf(EpisodeOutcome), never "opened".
  std::string detail;   ///< The numbers that explain it, for people.
  double peak_hinge_rad = 0;
  double peak_handle_rad = 0;
};

/// What decides a shard's content, apart from its episodes.
struct ShardHeader {
  int number = 0;             ///< In the file's name, 0..999999.
  std::string stage;          ///< "open", "handle" or "grasp".
  std::string split;          ///< "train", "val", ...
  std::string config_sha256;  ///< It hashes the effective config.
};

struct ShardIndex {
  ShardHeader header;
  std::string tar;  ///< File name, beside the index.
  std::uint64_t tar_bytes = 0;
  std::string tar_sha256;
  std::vector<ShardEpisode> episodes;   ///< In file order.
  std::vector<FailedEpisode> failures;  ///< In the plan's order.
};

/// "shard-000007".
std::string ShardStem(int number);

nlohmann::ordered_json ShardIndexToJson(const ShardIndex& index);
/// The index file's text: the JSON with two spaces of indentation and, as its last member,
/// `index_crc32c`, the CRC-32C of the text without this member.
std::string ShardIndexText(const ShardIndex& index);
/// Throws Error(kFormat) unless every range lies in the tar, none overlap, keys are unique and
/// without dots, and all keys have the same members.
ShardIndex ShardIndexFromJson(const nlohmann::ordered_json& json, const std::string& path);
/// Also throws where the text is not what its own checksum says. Indices of earlier builds have
/// none.
ShardIndex ReadShardIndex(const std::filesystem::path& path);

enum class ShardCommit {
  kWritten,
  kAlreadyThere,  ///< Another writer had committed the same bytes.
};

/// What becomes of a shard whose writer ends before Commit().
enum class Unfinished {
  kDiscard,  ///< It is removed, and a new writer begins anew.
  kKeep,     ///< A new writer goes on after the last episode that is whole.
};

/// Writes one shard. Nothing appears under the final names before Commit(). Memory use does not
/// grow with the shard.
///
/// Until then there are, hidden beside it, `.shard-N.tar.partial`, the tar as far as it has come,
/// and `.shard-N.journal`: a line for the header and for every episode or failure, written after
/// the episode's bytes, each behind its own CRC-32C. A writer that goes on reads the journal,
/// checks what it names in the tar against tar headers and CRCs, and cuts both files after the last
/// entry that holds. Both are synced every 8 MiB: a killed process loses only the episode at hand,
/// a power cut at most these. The journal is locked while it is written.
class ShardWriter {
 public:
  /// Creates the folder if need be.
  ///
  /// @throws Error(kInvalidArgument) on a bad number, if another process is writing this shard, or
  ///     if what there is to go on with has another header; Error(kIo).
  ShardWriter(std::filesystem::path folder, ShardHeader header,
              Unfinished unfinished = Unfinished::kDiscard, FileSystem& files = SystemFiles());
  ~ShardWriter();
  ShardWriter(const ShardWriter&) = delete;
  ShardWriter& operator=(const ShardWriter&) = delete;

  /// Keys of the episodes and failures that are in, in the order in which they were added; after
  /// construction those that an earlier writer left.
  const std::vector<std::string>& keys() const { return keys_; }

  /// Appends an episode; members are sorted by name. After an Error(kIo) the writer takes nothing
  /// more.
  ///
  /// @throws Error(kInvalidArgument) if the key is empty, has a dot, slash or blank or was there
  ///     before, or if the members' names are not those of the first episode; Error(kIo).
  void Add(const std::string& key, std::uint64_t decisions, std::vector<MemberBytes> members);

  /// Throws as Add().
  void AddFailure(FailedEpisode failure);

  /// Ends the tar, syncs and renames it, and writes the index last.
  ///
  /// If the shard is already committed, nothing is overwritten: the same bytes are fine, different
  /// ones throw Error(kInvalidArgument). A tar without an index is a crashed writer's and is
  /// replaced.
  ShardCommit Commit();

 private:
  struct Output;

  void Note(const std::string& key, const nlohmann::ordered_json& entry);

  std::filesystem::path folder_;
  ShardIndex index_;
  std::vector<std::string> keys_;
  std::unique_ptr<Output> output_;
};

/// Whether an unfinished shard, or what its writer could not remove, lies in the folder.
bool HasShardLeftovers(const std::filesystem::path& folder, int number);

/// Removes the journal and the partial tar of a committed shard whose writer was killed at the very
/// end, unless someone is writing them. Throws Error(kIo).
void RemoveShardLeftovers(FileSystem& files, const std::filesystem::path& folder, int number);

/// When members are checked against the index.
enum class CrcCheck { kOnFirstRead, kOnEveryRead, kNever };

/// Reads a committed shard through a memory map. Safe to use from several threads.
///
/// Another program that cuts the tar meanwhile ends nothing here: what is gone reads as zeros.
/// Read() refuses it where it checks; who goes on using spans that Read() gave before calls
/// RequireWhole() after the work, and gives away no result where that throws.
class ShardReader {
 public:
  /// @param index_path The .index.json file.
  /// @throws Error(kMissing, kIo or kFormat), naming the file and what is wrong, such as a tar that
  ///     is shorter than its index says.
  explicit ShardReader(const std::filesystem::path& index_path,
                       CrcCheck check = CrcCheck::kOnFirstRead);
  ~ShardReader();
  ShardReader(ShardReader&&) noexcept;
  ShardReader& operator=(ShardReader&&) noexcept;

  const ShardIndex& index() const { return index_; }

  /// Bytes of a member, valid while the reader lives; 64-byte aligned .npy data.
  ///
  /// @throws Error(kMissing) if the episode has no such member, Error(kFormat) if its checksum is
  ///     wrong; the message names tar, member and byte range.
  std::span<const std::byte> Read(std::size_t episode, std::string_view member) const;

  /// Every member of every episode against its checksum, and the tar against its SHA-256 and its
  /// own headers. Each fault is one line; empty if all is well. Throws as RequireWhole().
  std::vector<std::string> FindFaults() const;

  /// Throws Error(kIo), naming the tar, if a part of it was gone when it was read, or is by now.
  void RequireWhole() const;

  /// The bytes of the tar outside the members: headers, padding and end have but one form. The
  /// first byte that differs, as a line; nothing if none does. Together with the members' checksums
  /// this covers each bit, and takes no time.
  std::optional<std::string> FindFrameFault() const;

  /// "path/shard-000000.tar: ep000012.cloud.npy", for messages.
  std::string Describe(std::size_t episode, std::string_view member) const;

 private:
  struct Mapping;

  ShardIndex index_;
  std::filesystem::path tar_path_;
  std::unique_ptr<Mapping> mapping_;
};

/// What can be had from a tar whose index is missing or whose end is cut off.
struct RecoveredShard {
  ShardIndex index;  ///< It lists the complete episodes; of the header only `tar` is set.
  std::vector<std::string> incomplete_keys;
  std::string fault;  ///< Why the tar ends early; empty if it does not.
};

/// Rebuilds an index from the tar alone. An episode counts as complete if it has all the members of
/// the first one and its arrays agree in their leading axis. Without an index a flipped bit in the
/// data cannot be noticed. Throws Error(kMissing or kIo), also where the tar is cut meanwhile.
RecoveredShard RecoverShard(const std::filesystem::path& tar_path);

}  // namespace doorforge
