// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <limits>
#include <set>
#include <span>

#include <nlohmann/json.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/record_id.h"
#include "doorforge/schemas/shard.h"
#include "doorforge/schemas/tar.h"

#include "datasets/shard_names.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kSchema = "doorforge.shard_index";

[[noreturn]] void ThrowFormat(const std::string& message) {
  throw Error(ErrorCode::kFormat, message);
}

const Json& ArrayOf(const Json& json, const std::string& key, const std::string& path) {
  const Json& array = MemberOf(json, key, path);
  if (!array.is_array()) ThrowFormat(path + "." + key + ": expected an array");
  return array;
}

// ValueOf() of a number that may not be negative.
std::uint64_t CountOf(const Json& json, const std::string& key, const std::string& path) {
  const Json& member = MemberOf(json, key, path);
  if (!member.is_number_unsigned()) ThrowFormat(path + "." + key + ": expected a count");
  return member.get<std::uint64_t>();
}

Json MemberToJson(const ShardMember& member) {
  return {{"name", member.name},
          {"offset", member.offset},
          {"size", member.size},
          {"crc32c", member.crc32c}};
}

ShardMember MemberFromJson(const Json& json, const std::string& path) {
  ShardMember member;
  member.name = ValueOf<std::string>(json, "name", path);
  member.offset = CountOf(json, "offset", path);
  member.size = CountOf(json, "size", path);
  const std::uint64_t crc32c = CountOf(json, "crc32c", path);
  if (crc32c > std::numeric_limits<std::uint32_t>::max())
    ThrowFormat(path + ".crc32c: more than 32 bits");
  member.crc32c = static_cast<std::uint32_t>(crc32c);
  if (!IsMemberName(member.name)) ThrowFormat(path + ".name: bad member name");
  return member;
}

// Ranges ascend, leave room for headers, and end within the tar.
void CheckRanges(const ShardIndex& index, const std::string& path) {
  std::uint64_t free_from = 0;
  for (const ShardEpisode& episode : index.episodes) {
    for (const ShardMember& member : episode.members) {
      const std::string where = path + ": " + episode.key + "." + member.name;
      if (member.offset % kTarBlock != 0 || member.offset < free_from + kTarBlock)
        ThrowFormat(where + ": overlaps the member before it");
      if (member.offset > index.tar_bytes || member.size > index.tar_bytes - member.offset)
        ThrowFormat(where + ": reaches beyond the tar's " + std::to_string(index.tar_bytes) +
                    " bytes");
      free_from = member.offset + member.size + TarPadding(member.size);
    }
  }
}

void CheckNames(const ShardIndex& index, const std::string& path) {
  std::set<std::string> keys;
  for (const ShardEpisode& episode : index.episodes) {
    if (!keys.insert(episode.key).second)
      ThrowFormat(path + ": key " + episode.key + " occurs twice");
    if (!SameMembers(index.episodes[0], episode))
      ThrowFormat(path + ": " + episode.key + " has other members than " + index.episodes[0].key);
  }
}

constexpr const char* kChecksum = "index_crc32c";

std::string WithChecksum(Json json) {
  const std::string text = JsonText(json, 2) + "\n";
  json[kChecksum] = Crc32c(std::as_bytes(std::span(text)));
  return JsonText(json, 2) + "\n";
}

// The file's text is the one that a writer of this JSON writes. One without checksum is of an
// earlier build, and then has no key that those did not write, such as a damaged name of the
// checksum.
void CheckText(Json json, const std::filesystem::path& path) {
  constexpr std::size_t kEarlierKeys = 11;
  const bool has_checksum = json.is_object() && json.contains(kChecksum);
  if (!has_checksum && json.size() == kEarlierKeys) return;
  if (has_checksum) {
    json.erase(kChecksum);
    if (WithChecksum(std::move(json)) == ReadFile(path)) return;
  }
  ThrowFormat(path.string() +
              ": damaged: its text is not what its own checksum says; delete it and collect this "
              "shard again");
}

}  // namespace

std::string ShardStem(int number) {
  char text[32];
  std::snprintf(text, sizeof text, "shard-%06d", number);
  return text;
}

Json ShardEpisodeToJson(const ShardEpisode& episode) {
  Json members = Json::array();
  for (const ShardMember& member : episode.members) members.push_back(MemberToJson(member));
  return {{"key", episode.key}, {"decisions", episode.decisions}, {"members", members}};
}

ShardEpisode ShardEpisodeFromJson(const Json& json, const std::string& path) {
  ShardEpisode episode;
  episode.key = ValueOf<std::string>(json, "key", path);
  episode.decisions = CountOf(json, "decisions", path);
  if (!IsKey(episode.key)) ThrowFormat(path + ".key: bad key \"" + episode.key + '"');
  for (const Json& member : ArrayOf(json, "members", path))
    episode.members.push_back(MemberFromJson(member, path + "." + episode.key));
  return episode;
}

Json FailedEpisodeToJson(const FailedEpisode& failure) {
  return {{"key", failure.key},
          {"door_id", failure.door_id},
          {"outcome", failure.outcome},
          {"detail", failure.detail},
          {"peak_hinge_rad", failure.peak_hinge_rad},
          {"peak_handle_rad", failure.peak_handle_rad}};
}

FailedEpisode FailedEpisodeFromJson(const Json& json, const std::string& path) {
  FailedEpisode failure;
  failure.key = ValueOf<std::string>(json, "key", path);
  failure.door_id = ValueOf<std::string>(json, "door_id", path);
  failure.outcome = ValueOf<std::string>(json, "outcome", path);
  failure.detail = ValueOf<std::string>(json, "detail", path);
  failure.peak_hinge_rad = ValueOf<double>(json, "peak_hinge_rad", path);
  failure.peak_handle_rad = ValueOf<double>(json, "peak_handle_rad", path);
  return failure;
}

Json ShardIndexToJson(const ShardIndex& index) {
  Json episodes = Json::array();
  for (const ShardEpisode& episode : index.episodes)
    episodes.push_back(ShardEpisodeToJson(episode));
  Json failures = Json::array();
  for (const FailedEpisode& failure : index.failures)
    failures.push_back(FailedEpisodeToJson(failure));
  return {{"schema", kSchema},
          {"schema_version", kShardSchemaVersion},
          {"number", index.header.number},
          {"stage", index.header.stage},
          {"split", index.header.split},
          {"config_sha256", index.header.config_sha256},
          {"tar", index.tar},
          {"tar_bytes", index.tar_bytes},
          {"tar_sha256", index.tar_sha256},
          {"episodes", episodes},
          {"failures", failures}};
}

ShardIndex ShardIndexFromJson(const Json& json, const std::string& path) {
  RequireSchema(json, std::string(kSchema), kShardSchemaVersion, path);
  ShardIndex index;
  index.header.number = ValueOf<int>(json, "number", path);
  index.header.stage = IdOf(json, "stage", path);
  index.header.split = IdOf(json, "split", path);
  index.header.config_sha256 = ValueOf<std::string>(json, "config_sha256", path);
  index.tar = ValueOf<std::string>(json, "tar", path);
  index.tar_bytes = CountOf(json, "tar_bytes", path);
  index.tar_sha256 = ValueOf<std::string>(json, "tar_sha256", path);
  if (index.tar != ShardStem(index.header.number) + ".tar")
    ThrowFormat(path + ".tar: \"" + index.tar + "\", expected " + ShardStem(index.header.number) +
                ".tar");
  for (const Json& episode : ArrayOf(json, "episodes", path))
    index.episodes.push_back(ShardEpisodeFromJson(episode, path + ".episodes"));
  for (const Json& failure : ArrayOf(json, "failures", path))
    index.failures.push_back(FailedEpisodeFromJson(failure, path + ".failures"));
  CheckNames(index, path);
  CheckRanges(index, path);
  return index;
}

std::string ShardIndexText(const ShardIndex& index) {
  return WithChecksum(ShardIndexToJson(index));
}

ShardIndex ReadShardIndex(const std::filesystem::path& path) {
  Json json = ReadJsonFile(path);
  CheckText(json, path);
  return ShardIndexFromJson(json, path.string());
}

bool IsKey(std::string_view key) {
  constexpr std::string_view kAllowed =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  return !key.empty() && key.size() <= 60 &&
         key.find_first_not_of(kAllowed) == std::string_view::npos;
}

bool IsMemberName(std::string_view name) {
  const std::size_t dot = name.find('.');
  return name.size() <= 39 && dot != 0 && dot != std::string_view::npos && dot + 1 < name.size() &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_.") == std::string_view::npos;
}

bool SameMembers(const ShardEpisode& a, const ShardEpisode& b) {
  return std::equal(a.members.begin(), a.members.end(), b.members.begin(), b.members.end(),
                    [](const ShardMember& x, const ShardMember& y) { return x.name == y.name; });
}

}  // namespace doorforge
