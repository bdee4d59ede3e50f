// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <optional>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/schemas/npy.h"
#include "doorforge/schemas/shard.h"
#include "doorforge/schemas/tar.h"

#include "datasets/mapped_file.h"
#include "datasets/shard_names.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

std::string CrcFault(const std::string& where, const ShardMember& member, std::uint32_t found) {
  return where + ": bytes " + std::to_string(member.offset) + " to " +
         std::to_string(member.offset + member.size) + " are damaged (CRC32C " +
         std::to_string(found) + ", written as " + std::to_string(member.crc32c) +
         "); delete the index and give the datagen command again to make this shard anew";
}

// Headers in the tar against members in the index.
void CompareHeaders(const TarListing& listing, const ShardIndex& index, const std::string& path,
                    std::vector<std::string>& faults) {
  if (!listing.is_complete) faults.push_back(path + ": " + listing.fault);
  std::vector<std::pair<std::string, const ShardMember*>> indexed;
  for (const ShardEpisode& episode : index.episodes) {
    for (const ShardMember& member : episode.members)
      indexed.emplace_back(episode.key + "." + member.name, &member);
  }
  const std::size_t count = std::min(indexed.size(), listing.members.size());
  for (std::size_t i = 0; i < count; ++i) {
    const TarMember& found = listing.members[i];
    const auto& [name, member] = indexed[i];
    if (found.name == name && found.offset == member->offset && found.size == member->size)
      continue;
    faults.push_back(path + ": holds " + found.name + " at byte " + std::to_string(found.offset) +
                     " where the index has " + name + " at " + std::to_string(member->offset));
    return;
  }
  if (listing.is_complete && indexed.size() != listing.members.size())
    faults.push_back(path + ": " + std::to_string(listing.members.size()) +
                     " members, the index has " + std::to_string(indexed.size()));
}

}  // namespace

struct ShardReader::Mapping {
  Mapping(const fs::path& path, std::size_t members, CrcCheck crc_check)
      : file(path), check(crc_check), checked(members) {}

  MappedFile file;
  CrcCheck check;
  std::vector<std::atomic<bool>> checked;  // one a member, episode by episode
};

ShardReader::ShardReader(const fs::path& index_path, CrcCheck check)
    : index_(ReadShardIndex(index_path)), tar_path_(index_path.parent_path() / index_.tar) {
  const std::size_t width = index_.episodes.empty() ? 0 : index_.episodes[0].members.size();
  mapping_ = std::make_unique<Mapping>(tar_path_, index_.episodes.size() * width, check);
  const std::size_t found = mapping_->file.bytes().size();
  if (found != index_.tar_bytes)
    throw Error(ErrorCode::kFormat, tar_path_.string() + ": " + std::to_string(found) +
                                        " bytes, its index says " +
                                        std::to_string(index_.tar_bytes) +
                                        "; the file was cut or replaced after it was written");
}

ShardReader::~ShardReader() = default;
ShardReader::ShardReader(ShardReader&&) noexcept = default;
ShardReader& ShardReader::operator=(ShardReader&&) noexcept = default;

std::string ShardReader::Describe(std::size_t episode, std::string_view member) const {
  return tar_path_.string() + ": " + index_.episodes.at(episode).key + "." + std::string(member);
}

std::span<const std::byte> ShardReader::Read(std::size_t episode, std::string_view member) const {
  Require(episode < index_.episodes.size(), ErrorCode::kInvalidArgument,
          tar_path_.string() + ": no episode number " + std::to_string(episode));
  const std::vector<ShardMember>& members = index_.episodes[episode].members;
  const auto found = std::find_if(members.begin(), members.end(),
                                  [&](const ShardMember& m) { return m.name == member; });
  if (found == members.end())
    throw Error(ErrorCode::kMissing, Describe(episode, member) + ": the shard has no such member");
  const std::span<const std::byte> bytes =
      mapping_->file.bytes().subspan(found->offset, found->size);
  std::atomic<bool>& checked =
      mapping_
          ->checked[episode * members.size() + static_cast<std::size_t>(found - members.begin())];
  if (mapping_->check == CrcCheck::kNever ||
      (mapping_->check == CrcCheck::kOnFirstRead && checked.load(std::memory_order_relaxed)))
    return bytes;
  const std::uint32_t crc32c = Crc32c(bytes);
  if (crc32c != found->crc32c) RequireWhole();
  if (crc32c != found->crc32c)
    throw Error(ErrorCode::kFormat, CrcFault(Describe(episode, member), *found, crc32c));
  checked.store(true, std::memory_order_relaxed);
  return bytes;
}

void ShardReader::RequireWhole() const { mapping_->file.RequireWhole(); }

std::optional<std::string> ShardReader::FindFrameFault() const {
  const std::span<const std::byte> bytes = mapping_->file.bytes();
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::uint64_t at = 0;
  // nothing if the tar goes on with `expected`
  const auto compare = [&](std::string_view expected) -> std::optional<std::string> {
    const std::string_view found = text.substr(std::min<std::size_t>(at, text.size()));
    const auto differs = std::mismatch(
        expected.begin(), expected.end(), found.begin(),
        found.begin() + static_cast<std::ptrdiff_t>(std::min(expected.size(), found.size())));
    if (differs.first == expected.end()) return std::nullopt;
    return tar_path_.string() + ": byte " +
           std::to_string(at + static_cast<std::uint64_t>(differs.first - expected.begin())) +
           ", outside the members, is damaged";
  };
  const std::string zeros(kTarEnd, '\0');
  for (const ShardEpisode& episode : index_.episodes) {
    for (const ShardMember& member : episode.members) {
      if (auto fault = compare(MakeTarHeader(episode.key + "." + member.name, member.size)))
        return fault;
      at = member.offset + member.size;
      const std::size_t padding = TarPadding(member.size);
      if (auto fault = compare(std::string_view(zeros).substr(0, padding))) return fault;
      at += padding;
    }
  }
  return compare(zeros);
}

std::vector<std::string> ShardReader::FindFaults() const {
  std::vector<std::string> faults;
  const std::span<const std::byte> bytes = mapping_->file.bytes();
  for (std::size_t i = 0; i < index_.episodes.size(); ++i) {
    for (const ShardMember& member : index_.episodes[i].members) {
      const std::uint32_t crc32c = Crc32c(bytes.subspan(member.offset, member.size));
      if (crc32c != member.crc32c)
        faults.push_back(CrcFault(Describe(i, member.name), member, crc32c));
    }
  }
  const std::size_t member_faults = faults.size();
  CompareHeaders(ListTar(bytes), index_, tar_path_.string(), faults);
  if (faults.size() == member_faults) {
    if (std::optional<std::string> fault = FindFrameFault()) faults.push_back(std::move(*fault));
  }
  Sha256 hash;
  hash.Update(bytes);
  if (hash.HexDigest() != index_.tar_sha256)
    faults.push_back(tar_path_.string() + ": its SHA-256 is not the one in the index");
  RequireWhole();
  return faults;
}

namespace {

// Members of one key as they come in the tar.
struct KeyRun {
  std::string key;
  std::vector<ShardMember> members;
};

std::vector<KeyRun> RunsOf(const TarListing& listing, std::span<const std::byte> bytes) {
  std::vector<KeyRun> runs;
  for (const TarMember& member : listing.members) {
    const std::size_t dot = std::min(member.name.find('.'), member.name.size());
    const std::string key = member.name.substr(0, dot);
    if (runs.empty() || runs.back().key != key) runs.push_back({key, {}});
    runs.back().members.push_back({member.name.substr(std::min(dot + 1, member.name.size())),
                                   member.offset, member.size,
                                   Crc32c(bytes.subspan(member.offset, member.size))});
  }
  return runs;
}

// Common length of the leading axes of a key's arrays; nothing if they differ or cannot be read.
std::optional<std::uint64_t> DecisionsOf(const KeyRun& run, std::span<const std::byte> bytes) {
  std::optional<std::uint64_t> decisions;
  for (const ShardMember& member : run.members) {
    if (!member.name.ends_with(".npy")) continue;
    try {
      const NpyHeader header =
          ParseNpyHeader(bytes.subspan(member.offset, member.size), member.name);
      if (header.shape.empty() || (decisions && *decisions != header.shape[0])) return std::nullopt;
      decisions = header.shape[0];
    } catch (const Error&) {
      return std::nullopt;
    }
  }
  return decisions;
}

}  // namespace

RecoveredShard RecoverShard(const fs::path& tar_path) {
  const MappedFile file(tar_path);
  const TarListing listing = ListTar(file.bytes());
  RecoveredShard recovered;
  recovered.fault = listing.fault;
  recovered.index.tar = tar_path.filename().string();
  recovered.index.tar_bytes = file.bytes().size();
  for (KeyRun& run : RunsOf(listing, file.bytes())) {
    const std::optional<std::uint64_t> decisions = DecisionsOf(run, file.bytes());
    ShardEpisode episode{run.key, decisions.value_or(0), std::move(run.members)};
    const std::vector<ShardEpisode>& kept = recovered.index.episodes;
    const bool is_complete =
        decisions && IsKey(episode.key) && (kept.empty() || SameMembers(kept[0], episode));
    if (is_complete) {
      recovered.index.episodes.push_back(std::move(episode));
    } else {
      recovered.incomplete_keys.push_back(episode.key);
    }
  }
  file.RequireWhole();
  return recovered;
}

}  // namespace doorforge
