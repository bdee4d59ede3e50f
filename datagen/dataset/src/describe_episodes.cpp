// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/describe_episodes.h"

#include <algorithm>
#include <cstdio>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/schemas/dataset.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Doors = std::map<std::string, DatasetDoor>;

// What the groups count of an episode, written or failed.
struct EpisodeFacts {
  std::string key;
  std::string door_id;
  std::string outcome;
  std::string detail;
  bool success = false;
  double peak_hinge_rad = 0;
  double peak_handle_rad = 0;
  std::uint64_t decisions = 0;  // 0 if it was not written
  bool has_preview = false;
};

struct ShardPlace {
  DatasetPart part;
  fs::path index;
};

Doors DoorsOf(const fs::path& folder) {
  const fs::path path = folder / "provenance.json";
  Doors doors;
  for (DatasetDoor& door : ProvenanceFromJson(ReadJsonFile(path), path.string()).doors)
    doors[door.id] = door;
  return doors;
}

const DatasetDoor& DoorNamed(const Doors& doors, const std::string& id) {
  const auto found = doors.find(id);
  Require(found != doors.end(), ErrorCode::kFormat,
          "door '" + id + "' has episodes but is not in provenance.json");
  return found->second;
}

EpisodeFacts FactsOf(const ShardReader& shard, std::size_t episode) {
  const Json meta = ReadEpisodeMeta(shard, episode);
  const std::string where = shard.Describe(episode, "meta.json");
  EpisodeFacts facts;
  facts.key = shard.index().episodes[episode].key;
  facts.decisions = shard.index().episodes[episode].decisions;
  facts.door_id = ValueOf<std::string>(MemberOf(meta, "scene", where), "door_id", where);
  facts.outcome = ValueOf<std::string>(meta, "outcome", where);
  facts.detail = ValueOf<std::string>(meta, "detail", where);
  facts.success = ValueOf<bool>(meta, "success", where);
  facts.peak_hinge_rad = ValueOf<double>(meta, "peak_hinge_rad", where);
  facts.peak_handle_rad = ValueOf<double>(meta, "peak_handle_rad", where);
  return facts;
}

std::vector<EpisodeFacts> FactsOfShard(const fs::path& index) {
  const ShardReader shard(index);
  std::vector<EpisodeFacts> all;
  for (std::size_t i = 0; i < shard.index().episodes.size(); ++i) {
    const auto& members = shard.index().episodes[i].members;
    all.push_back(FactsOf(shard, i));
    all.back().has_preview = std::any_of(members.begin(), members.end(), [](const ShardMember& m) {
      return m.name == "preview.png";
    });
  }
  for (const FailedEpisode& failure : shard.index().failures)
    all.push_back({failure.key, failure.door_id, failure.outcome, failure.detail, false,
                   failure.peak_hinge_rad, failure.peak_handle_rad, 0, false});
  return all;
}

std::string PreviewOf(const fs::path& index, std::size_t episode) {
  const ShardReader shard(index);
  const std::span<const std::byte> png = shard.Read(episode, "preview.png");
  std::string copy(reinterpret_cast<const char*>(png.data()), png.size());
  shard.RequireWhole();
  return copy;
}

void Count(EpisodeGroup& group, const EpisodeFacts& facts) {
  ++group.episodes;
  if (facts.success) {
    ++group.succeeded;
  } else {
    ++group.causes[facts.outcome];
  }
  group.hinge.Add(facts.peak_hinge_rad);
  group.handle.Add(facts.peak_handle_rad);
}

class Builder {
 public:
  Builder(const Doors& doors, int examples) : doors_(doors), examples_(examples) {}

  // `position` is the episode's in the shard, if it was written.
  void Add(const ShardPlace& place, std::size_t position, const EpisodeFacts& facts) {
    const DatasetDoor& door = DoorNamed(doors_, facts.door_id);
    StageEpisodes& stage = stages_[place.part.stage];
    stage.stage = place.part.stage;
    Count(stage.all, facts);
    Count(stage.by_category[door.category], facts);
    Count(stage.by_mechanism[door.mechanism], facts);
    Count(stage.by_split[place.part.split], facts);
    if (facts.decisions > 0)
      ++stage.decisions[facts.decisions];
    else if (!facts.success)
      unwritten_.push_back({place.part.stage + "/" + place.part.split, facts.key, facts.door_id,
                            facts.outcome, facts.detail});
    std::vector<ExampleEpisode>& shown = shown_[{place.part.stage, door.category}];
    if (!facts.has_preview || static_cast<int>(shown.size()) >= examples_) return;
    shown.push_back({place.part.stage + "/" + place.part.split, facts.key, facts.door_id,
                     door.category, facts.detail, PreviewOf(place.index, position)});
  }

  EpisodeDescription Finish() {
    EpisodeDescription description;
    description.unwritten = std::move(unwritten_);
    for (auto& [name, stage] : stages_) description.stages.push_back(std::move(stage));
    for (auto& [kind, shown] : shown_)
      std::move(shown.begin(), shown.end(), std::back_inserter(description.examples));
    return description;
  }

 private:
  const Doors& doors_;
  int examples_;
  std::map<std::string, StageEpisodes> stages_;
  std::map<std::pair<std::string, std::string>, std::vector<ExampleEpisode>> shown_;
  std::vector<UnwrittenEpisode> unwritten_;
};

Json HistogramToJson(const AngleHistogram& histogram) {
  return {{"bin_width_rad", AngleHistogram::kBinWidth_rad}, {"counts", histogram.counts}};
}

Json GroupToJson(const EpisodeGroup& group) {
  return {{"episodes", group.episodes},
          {"succeeded", group.succeeded},
          {"success_rate", group.episodes > 0 ? static_cast<double>(group.succeeded) /
                                                    static_cast<double>(group.episodes)
                                              : 0},
          {"causes", group.causes},
          {"hinge", HistogramToJson(group.hinge)},
          {"handle", HistogramToJson(group.handle)}};
}

Json GroupsToJson(const std::map<std::string, EpisodeGroup>& groups) {
  Json json = Json::object();
  for (const auto& [name, group] : groups) json[name] = GroupToJson(group);
  return json;
}

std::string GroupLine(const std::string& name, const EpisodeGroup& group) {
  std::string causes;
  for (const auto& [cause, count] : group.causes)
    causes += (causes.empty() ? "" : ", ") + std::to_string(count) + " " + cause;
  char text[96];
  std::snprintf(text, sizeof text, "  %-17s %8llu  %5.1f %%  ", name.c_str(),
                static_cast<unsigned long long>(group.episodes),
                100.0 * static_cast<double>(group.succeeded) /
                    static_cast<double>(std::max<std::uint64_t>(group.episodes, 1)));
  return text + causes + "\n";
}

}  // namespace

void AngleHistogram::Add(double angle_rad) {
  const double bin = std::clamp(angle_rad / kBinWidth_rad, 0.0, kBins - 1.0);
  ++counts[static_cast<std::size_t>(bin)];
}

EpisodeDescription DescribeEpisodes(const fs::path& folder, int examples, int threads) {
  const Doors doors = DoorsOf(folder);
  std::vector<ShardPlace> places;
  for (const DatasetPart& part : ReadDataset(folder).parts)
    for (const fs::path& path : ShardIndices(folder, part.stage, part.split))
      places.push_back({part, path});
  std::vector<std::vector<EpisodeFacts>> facts(places.size());
  ParallelFor(places.size(), threads,
              [&](std::size_t i) { facts[i] = FactsOfShard(places[i].index); });
  Builder builder(doors, examples);
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t k = 0; k < facts[i].size(); ++k) builder.Add(places[i], k, facts[i][k]);
  return builder.Finish();
}

Json StagesToJson(const EpisodeDescription& description) {
  Json stages = Json::array();
  for (const StageEpisodes& stage : description.stages) {
    Json decisions = Json::object();
    for (const auto& [length, count] : stage.decisions) decisions[std::to_string(length)] = count;
    stages.push_back({{"stage", stage.stage},
                      {"all", GroupToJson(stage.all)},
                      {"by_category", GroupsToJson(stage.by_category)},
                      {"by_mechanism", GroupsToJson(stage.by_mechanism)},
                      {"by_split", GroupsToJson(stage.by_split)},
                      {"episodes_by_decisions", decisions}});
  }
  return stages;
}

std::string StagesText(const EpisodeDescription& description) {
  std::string text;
  for (const StageEpisodes& stage : description.stages) {
    text += "\n" + stage.stage + "              episodes  success  causes of failure\n";
    for (const auto& [name, group] : stage.by_category) text += GroupLine(name, group);
    for (const auto& [name, group] : stage.by_mechanism) text += GroupLine(name, group);
  }
  return text;
}

}  // namespace doorforge
