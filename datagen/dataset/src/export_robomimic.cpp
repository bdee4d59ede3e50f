// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/export_robomimic.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/file_system.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/free_space.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/npy.h"

#include "action_scaling.h"
#include "hdf5_file.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using internal::Hdf5Writer;
using Json = nlohmann::ordered_json;

// Beside the arrays: groups, headers and meta data of an episode.
constexpr std::uint64_t kOverheadPerEpisode = 32768;

// What a robot knows of itself and its camera shows; all else is the answer, or known to the
// simulator alone.
constexpr std::array<std::string_view, 2> kObserved = {"cloud", "proprio"};

bool IsObserved(std::string_view name) {
  return std::find(kObserved.begin(), kObserved.end(), name) != kObserved.end();
}

// An array of an episode. The bytes are a copy: a write straight from the map would fail as if the
// disk were full where another program has cut the shard.
struct CopiedArray {
  NpyHeader header;
  std::vector<std::byte> bytes;

  std::span<const std::byte> data() const { return std::span(bytes).subspan(header.data_offset); }
};

CopiedArray CopyArray(const ShardReader& shard, std::size_t episode, const std::string& member) {
  const std::span<const std::byte> mapped = shard.Read(episode, member);
  CopiedArray array{{}, {mapped.begin(), mapped.end()}};
  shard.RequireWhole();
  array.header = ParseNpyHeader(array.bytes, shard.Describe(episode, member));
  return array;
}

std::vector<float> ActionsOf(const ShardReader& shard, std::size_t episode) {
  const std::string member = "action.npy";
  const CopiedArray array = CopyArray(shard, episode, member);
  const std::vector<std::size_t>& shape = array.header.shape;
  Require(array.header.type == "<f4" && shape.size() == 2 && shape[1] == internal::kActionNumbers,
          ErrorCode::kFormat,
          shard.Describe(episode, member) + ": expected T x 9 numbers of the type <f4");
  std::vector<float> actions(array.data().size() / sizeof(float));
  std::memcpy(actions.data(), array.data().data(), array.data().size());
  return actions;
}

internal::ActionScaling ScalingOf(const fs::path& folder, const std::vector<DatasetPart>& parts) {
  internal::ActionRange range;
  for (const DatasetPart& part : parts) {
    const DatasetReader reader(folder, part.stage, part.split);
    for (const ShardReader& shard : reader.shards())
      for (std::size_t i = 0; i < shard.index().episodes.size(); ++i)
        range.Add(ActionsOf(shard, i));
  }
  return range.Scaling();
}

std::vector<DatasetPart> PartsOfStage(const fs::path& folder, const std::string& stage) {
  std::vector<DatasetPart> parts;
  std::string there;
  for (const DatasetPart& part : ReadDataset(folder).parts) {
    there += " " + part.stage + "/" + part.split;
    if (part.stage == stage && part.episodes > 0) parts.push_back(part);
  }
  const bool any_decision = std::any_of(parts.begin(), parts.end(),
                                        [](const DatasetPart& part) { return part.decisions > 0; });
  if (!parts.empty() && !any_decision)
    throw Error(ErrorCode::kInvalidArgument,
                folder.string() + ": the episodes of stage '" + stage +
                    "' hold 0 decisions, so there is nothing to export; verify the dataset");
  if (parts.empty())
    throw Error(ErrorCode::kMissing, folder.string() + ": no episodes of stage '" + stage +
                                         "'; the dataset has" + (there.empty() ? " none" : there));
  return parts;
}

void RequireSpaceForFile(const fs::path& out, const std::vector<DatasetPart>& parts) {
  double wanted = 0;
  for (const DatasetPart& part : parts)
    wanted += static_cast<double>(part.bytes + part.episodes * kOverheadPerEpisode);
  RequireSpace(out.parent_path(), wanted, "make room, or choose another --out");
}

DatasetProvenance ProvenanceIn(const fs::path& folder) {
  const fs::path path = folder / "provenance.json";
  return ProvenanceFromJson(ReadJsonFile(path), path.string());
}

// A file in a hidden folder beside `target` that takes its place when it is complete, or goes. One
// writer at a time: what a killed one left is in the same folder and goes with the next.
class PartialFile {
 public:
  explicit PartialFile(const fs::path& target)
      : target_(target),
        folder_(target.parent_path() / ("." + target.filename().string() + ".export")),
        lock_(std::in_place, folder_, "doorforge dataset export", Writers::kOne) {
    SystemFiles().Remove(path());
  }
  ~PartialFile() {
    std::error_code ignored;
    fs::remove(path(), ignored);
    lock_.reset();
    fs::remove(folder_, ignored);
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  fs::path path() const { return folder_ / target_.filename(); }

  void Commit(Existing existing) {
    FileSystem& files = SystemFiles();
    const int file = files.OpenToAppend(path());
    try {
      files.Sync(file, path());
    } catch (...) {
      files.Close(file);
      throw;
    }
    files.Close(file);
    if (existing == Existing::kReplace) {
      files.Rename(path(), target_);
    } else if (!files.RenameToNew(path(), target_)) {
      throw Error(ErrorCode::kInvalidArgument,
                  target_.string() + ": appeared meanwhile; pass --overwrite to replace it");
    }
    files.SyncFolder(target_.has_parent_path() ? target_.parent_path() : fs::path("."));
  }

 private:
  fs::path target_;
  fs::path folder_;
  std::optional<FolderLock> lock_;
};

class Exporter {
 public:
  Exporter(const RobomimicRequest& request, const internal::ActionScaling& scaling,
           const fs::path& path)
      : request_(request),
        scaling_(scaling),
        provenance_(ProvenanceIn(request.folder)),
        file_(path) {
    for (const DatasetDoor& door : provenance_.doors) doors_[door.id] = &door;
    file_.MakeGroup("data");
  }

  // Returns false if a signal asked to stop.
  bool AddPart(const DatasetPart& part) {
    const DatasetReader reader(request_.folder, part.stage, part.split);
    for (const ShardReader& shard : reader.shards()) {
      for (std::size_t i = 0; i < shard.index().episodes.size(); ++i) {
        if (StopRequested() != 0) return false;
        AddEpisode(shard, i, part.split);
        if (request_.on_episode) request_.on_episode();
      }
    }
    return true;
  }

  RobomimicSummary Finish() {
    for (const auto& [split, demos] : masks_) file_.WriteTexts("mask/" + split, demos);
    const Json env = {{"env_name", "doorforge"},
                      {"type", 2},
                      {"env_version", provenance_.code_version},
                      {"env_kwargs", {{"stage", request_.stage}, {"seed", provenance_.seed}}}};
    file_.SetAttribute("data", "total", static_cast<std::int64_t>(summary_.samples));
    file_.SetAttribute("data", "env_args", JsonText(env));
    file_.SetAttribute("data", "schema", "doorforge.robomimic 2");
    file_.SetAttribute("data", "action_scale", scaling_.scale);
    file_.SetAttribute("data", "action_offset", scaling_.offset);
    file_.SetAttribute("data", "config_sha256", provenance_.config_sha256);
    file_.Close();
    return summary_;
  }

 private:
  void AddEpisode(const ShardReader& shard, std::size_t episode, const std::string& split) {
    const std::string demo = "demo_" + std::to_string(summary_.demos);
    const std::string group = "data/" + demo;
    for (const ShardMember& member : shard.index().episodes[episode].members)
      if (member.name.ends_with(".npy")) AddArray(shard, episode, member.name, group + "/");
    const std::size_t decisions = AddActions(shard, episode, group);
    std::vector<std::uint8_t> dones(decisions, 0);
    if (decisions > 0) dones.back() = 1;
    file_.WriteArray(group + "/dones", "|u1", {decisions}, std::as_bytes(std::span(dones)));
    DescribeEpisode(shard, episode, group);
    file_.SetAttribute(group, "num_samples", static_cast<std::int64_t>(decisions));
    file_.SetAttribute(group, "split", split);
    masks_[split].push_back(demo);
    ++summary_.demos;
    summary_.samples += decisions;
  }

  // Returns the number of decisions.
  std::size_t AddActions(const ShardReader& shard, std::size_t episode, const std::string& group) {
    const std::vector<float> scaled = scaling_.Scaled(ActionsOf(shard, episode));
    const std::size_t decisions = scaled.size() / internal::kActionNumbers;
    file_.WriteArray(group + "/actions", "<f4", {decisions, internal::kActionNumbers},
                     std::as_bytes(std::span(scaled)));
    return decisions;
  }

  void AddArray(const ShardReader& shard, std::size_t episode, const std::string& member,
                const std::string& group) {
    const CopiedArray array = CopyArray(shard, episode, member);
    const std::string name = member.substr(0, member.size() - 4);
    std::vector<std::size_t> shape = array.header.shape;
    std::string path = group + (IsObserved(name) ? "obs/" : "extras/") + name;
    if (name == "score") {
      path = group + "rewards";
      shape.resize(1);
    }
    file_.WriteArray(path, array.header.type, shape, array.data());
  }

  void DescribeEpisode(const ShardReader& shard, std::size_t episode, const std::string& group) {
    const Json meta = ReadEpisodeMeta(shard, episode);
    const std::string where = shard.Describe(episode, "meta.json");
    file_.WriteText(group + "/meta", JsonText(meta));
    file_.SetAttribute(group, "success", ValueOf<bool>(meta, "success", where) ? 1 : 0);
    file_.SetAttribute(group, "key", shard.index().episodes[episode].key);
    const std::string id = ValueOf<std::string>(MemberOf(meta, "scene", where), "door_id", where);
    const auto door = doors_.find(id);
    Require(door != doors_.end(), ErrorCode::kFormat,
            where + ": door '" + id + "' is not in provenance.json");
    file_.SetAttribute(group, "door_id", id);
    file_.SetAttribute(group, "category", door->second->category);
    file_.SetAttribute(group, "mechanism", door->second->mechanism);
  }

  const RobomimicRequest& request_;
  internal::ActionScaling scaling_;
  DatasetProvenance provenance_;
  std::map<std::string, const DatasetDoor*> doors_;
  Hdf5Writer file_;
  std::map<std::string, std::vector<std::string>> masks_;
  RobomimicSummary summary_;
};

}  // namespace

std::uint64_t CountEpisodes(const fs::path& folder, const std::string& stage) {
  std::uint64_t episodes = 0;
  for (const DatasetPart& part : PartsOfStage(folder, stage)) episodes += part.episodes;
  return episodes;
}

RobomimicSummary ExportRobomimic(const RobomimicRequest& request) {
  if (request.existing == Existing::kRefuse && fs::exists(request.out))
    throw Error(ErrorCode::kInvalidArgument,
                request.out.string() + ": already exists; pass --overwrite to replace it");
  const std::vector<DatasetPart> parts = PartsOfStage(request.folder, request.stage);
  if (request.out.has_parent_path()) SystemFiles().CreateFolder(request.out.parent_path());
  RequireSpaceForFile(request.out, parts);
  PartialFile partial(request.out);
  Exporter exporter(request, ScalingOf(request.folder, parts), partial.path());
  for (const DatasetPart& part : parts) {
    if (!exporter.AddPart(part)) return {.stopped_by_signal = StopRequested()};
  }
  RobomimicSummary summary = exporter.Finish();
  partial.Commit(request.existing);
  summary.bytes = fs::file_size(request.out);
  return summary;
}

Json ExportToJson(const RobomimicRequest& request, const RobomimicSummary& summary) {
  return {{"schema", "doorforge.dataset_export"},
          {"schema_version", 1},
          {"to", "robomimic"},
          {"stage", request.stage},
          {"out", request.out.string()},
          {"demos", summary.demos},
          {"samples", summary.samples},
          {"bytes", summary.bytes}};
}

std::string ExportText(const RobomimicRequest& request, const RobomimicSummary& summary) {
  char text[120];
  std::snprintf(text, sizeof text, ": %llu demos, %llu samples, %.1f MiB\n",
                static_cast<unsigned long long>(summary.demos),
                static_cast<unsigned long long>(summary.samples),
                static_cast<double>(summary.bytes) / (1 << 20));
  return request.out.string() + text;
}

}  // namespace doorforge
