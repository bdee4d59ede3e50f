// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/describe_dataset.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>
#include <vector>

#include "doorforge/core/json_file.h"
#include "doorforge/dataset/describe_episodes.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/episode.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct KindCount {
  std::uint64_t doors = 0;
  std::uint64_t failed = 0;
};

Json PartToJson(const DatasetPart& part) {
  const auto attempts = static_cast<double>(part.episodes + part.failed_episodes);
  const auto episodes = static_cast<double>(part.episodes);
  return {{"stage", part.stage},
          {"split", part.split},
          {"shards", part.shards},
          {"episodes", part.episodes},
          {"failed_episodes", part.failed_episodes},
          {"success_rate", attempts > 0 ? episodes / attempts : 0},
          {"decisions", part.decisions},
          {"decisions_per_episode",
           part.episodes > 0 ? static_cast<double>(part.decisions) / episodes : 0},
          {"bytes", part.bytes}};
}

// Failed episodes by cause, and by the kind of their door.
struct FailureCounts {
  std::map<std::string, std::uint64_t> by_cause;
  std::map<std::string, std::uint64_t> by_door;
};

FailureCounts CountFailures(const fs::path& folder, const DatasetRecord& record) {
  FailureCounts counts;
  for (const DatasetPart& part : record.parts) {
    for (const fs::path& path : ShardIndices(folder, part.stage, part.split)) {
      for (const FailedEpisode& failure : ReadShardIndex(path).failures) {
        ++counts.by_cause[failure.outcome];
        ++counts.by_door[failure.door_id];
      }
    }
  }
  return counts;
}

// Grasps are kept whether they succeed or not, and the indices alone do not say which did.
void CountKeptFailures(const fs::path& folder, Json& parts) {
  const auto keeps = [](const Json& part) { return part.at("stage") == NameOf(Stage::kGrasp); };
  if (std::none_of(parts.begin(), parts.end(), keeps)) return;
  for (const StageEpisodes& stage : DescribeEpisodes(folder, 0).stages)
    for (Json& part : parts) {
      const auto group = stage.by_split.find(part.at("split").get<std::string>());
      if (part.at("stage") == stage.stage && group != stage.by_split.end())
        part["success_rate"] = static_cast<double>(group->second.succeeded) /
                               static_cast<double>(group->second.episodes);
    }
}

std::string PartLine(const Json& part) {
  char text[160];
  std::snprintf(
      text, sizeof text, "%-8s %-7s %8llu  %5.1f %%  %9llu  %6llu  %7.1f\n",
      part.at("stage").get<std::string>().c_str(), part.at("split").get<std::string>().c_str(),
      part.at("episodes").get<unsigned long long>(), 100 * part.at("success_rate").get<double>(),
      part.at("decisions").get<unsigned long long>(), part.at("shards").get<unsigned long long>(),
      part.at("bytes").get<double>() / (1 << 20));
  return text;
}

std::string DoorLine(const Json& door) {
  char text[160];
  std::snprintf(text, sizeof text, "%-17s %-9s %6llu  %15llu\n",
                door.at("category").get<std::string>().c_str(),
                door.at("mechanism").get<std::string>().c_str(),
                door.at("doors").get<unsigned long long>(),
                door.at("failed_episodes").get<unsigned long long>());
  return text;
}

std::string CauseLine(const std::string& cause, std::uint64_t count) {
  char text[160];
  std::snprintf(text, sizeof text, "%-17s %8llu\n", cause.c_str(),
                static_cast<unsigned long long>(count));
  return text;
}

}  // namespace

Json DescribeDataset(const fs::path& folder) {
  const DatasetRecord record = ReadDataset(folder);
  const fs::path provenance_path = folder / "provenance.json";
  const DatasetProvenance provenance =
      ProvenanceFromJson(ReadJsonFile(provenance_path), provenance_path.string());
  const FailureCounts failures = CountFailures(folder, record);
  std::map<std::pair<std::string, std::string>, KindCount> kinds;
  for (const DatasetDoor& door : provenance.doors) {
    KindCount& kind = kinds[{door.category, door.mechanism}];
    ++kind.doors;
    const auto failed = failures.by_door.find(door.id);
    if (failed != failures.by_door.end()) kind.failed += failed->second;
  }
  Json parts = Json::array();
  for (const DatasetPart& part : record.parts) parts.push_back(PartToJson(part));
  CountKeptFailures(folder, parts);
  Json doors = Json::array();
  for (const auto& [kind, count] : kinds)
    doors.push_back({{"category", kind.first},
                     {"mechanism", kind.second},
                     {"doors", count.doors},
                     {"failed_episodes", count.failed}});
  return {{"schema", "doorforge.dataset_description"},
          {"schema_version", 1},
          {"folder", folder.string()},
          {"code_version", provenance.code_version},
          {"seed", provenance.seed},
          {"config_sha256", provenance.config_sha256},
          {"parts", parts},
          {"doors", doors},
          {"failures", failures.by_cause},
          {"train_cloud_radius_m", record.cloud_radius_m}};
}

std::string DescriptionText(const Json& description) {
  std::string text = description.at("folder").get<std::string>() + ": doorforge " +
                     description.at("code_version").get<std::string>() + ", seed " +
                     std::to_string(description.at("seed").get<std::uint64_t>()) + "\n\n";
  text += "stage    split   episodes  success  decisions  shards      MiB\n";
  for (const Json& part : description.at("parts")) text += PartLine(part);
  text += "\ncategory          mechanism  doors  failed episodes\n";
  for (const Json& door : description.at("doors")) text += DoorLine(door);
  std::vector<std::pair<std::uint64_t, std::string>> causes;
  for (const auto& [cause, count] : description.at("failures").items())
    causes.emplace_back(count.get<std::uint64_t>(), cause);
  std::sort(causes.rbegin(), causes.rend());
  if (!causes.empty()) text += "\nfailed episodes by cause\n";
  for (const auto& [count, cause] : causes) text += CauseLine(cause, count);
  return text;
}

}  // namespace doorforge
