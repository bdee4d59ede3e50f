// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "dataset_records.h"

#include <algorithm>
#include <set>
#include <sstream>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// The first line in which two texts differ, for a message.
std::string FirstDifference(const std::string& there, const std::string& here) {
  std::istringstream a(there);
  std::istringstream b(here);
  std::string line_a;
  std::string line_b;
  while (line_a == line_b && (a || b)) {
    if (!std::getline(a, line_a)) line_a = "(end)";
    if (!std::getline(b, line_b)) line_b = "(end)";
  }
  return "there: " + line_a + "\nnow:   " + line_b;
}

void CompareConfig(const fs::path& path, const std::string& text) {
  const std::string there = ReadFile(path);
  if (there == text) return;
  throw Error(ErrorCode::kInvalidArgument, path.string() +
                                               ": the folder holds episodes of another config; "
                                               "give the same settings to go on, or another "
                                               "--out\n" +
                                               FirstDifference(there, text));
}

void CommitConfig(FileSystem& files, const fs::path& path, const std::string& text) {
  if (!fs::exists(path)) {
    try {
      CommitFile(files, path, text, Existing::kRefuse);
      return;
    } catch (const Error& error) {
      // another task was faster
      if (error.code() != ErrorCode::kInvalidArgument) throw;
    }
  }
  CompareConfig(path, text);
}

void CommitUnlessSame(FileSystem& files, const fs::path& path, const std::string& text) {
  if (!fs::exists(path) || ReadFile(path) != text) CommitFile(files, path, text);
}

// Ids of the doors of one split, sorted, one a line.
std::string SplitLines(const DatasetProvenance& provenance, const std::string& split) {
  std::set<std::string> ids;
  for (const DatasetDoor& door : provenance.doors) {
    if (door.split == split) ids.insert(door.id);
  }
  std::string lines;
  for (const std::string& id : ids) lines += id + "\n";
  return lines;
}

fs::path IndexPathOf(const fs::path& folder, const ExpectedShard& shard) {
  return folder / (shard.Name() + ".index.json");
}

void RequireAllShards(const fs::path& folder, const DatasetProvenance& provenance,
                      const std::vector<ExpectedShard>& shards) {
  constexpr std::size_t kMostNamed = 20;
  std::vector<std::string> faults;
  for (std::size_t i = 0; i < shards.size(); ++i) {
    const std::string fault = PlanFaultOf(folder, shards[i], provenance.config_sha256);
    if (!fault.empty())
      faults.push_back(shards[i].Name() + " (number " + std::to_string(i) +
                       " of the plan): " + fault);
  }
  if (faults.empty()) return;
  std::string message = folder.string() + ": " + std::to_string(faults.size()) + " of " +
                        std::to_string(shards.size()) +
                        " planned shards are not there; give the same `datagen` command again, or "
                        "its tasks that own them (shard k belongs to task k mod N):";
  for (std::size_t i = 0; i < std::min(faults.size(), kMostNamed); ++i)
    message += "\n  " + faults[i];
  if (faults.size() > kMostNamed)
    message += "\n  and " + std::to_string(faults.size() - kMostNamed) + " more";
  throw Error(ErrorCode::kIncomplete, message);
}

std::string FailureLines(const fs::path& folder, const std::vector<ExpectedShard>& shards) {
  std::string lines;
  for (const ExpectedShard& shard : shards) {
    const DatasetPart part{shard.stage, shard.split, 0, 0, 0, 0, 0};
    for (const FailedEpisode& failure : ReadShardIndex(IndexPathOf(folder, shard)).failures)
      lines += FailureLine(failure, part) + "\n";
  }
  return lines;
}

std::string RecordText(const nlohmann::ordered_json& json) { return JsonText(json, 2) + "\n"; }

}  // namespace

std::string ExpectedShard::Name() const {
  return (fs::path(stage) / split / ShardStem(number)).string();
}

std::vector<ExpectedShard> ExpectedShards(const DatasetProvenance& provenance) {
  std::vector<ExpectedShard> shards;
  for (const PlannedPart& part : provenance.planned) {
    for (std::uint64_t k = 0; k < part.shards; ++k)
      shards.push_back(
          {part.stage, part.split, static_cast<int>(k),
           std::min(part.episodes_per_shard, part.episodes - k * part.episodes_per_shard)});
  }
  return shards;
}

std::string PlanFaultOf(const fs::path& folder, const ExpectedShard& shard,
                        const std::string& config_sha256) {
  const fs::path path = IndexPathOf(folder, shard);
  if (!fs::exists(path)) return "missing";
  const ShardIndex index = ReadShardIndex(path);
  if (index.header.config_sha256 != config_sha256) return "of another config";
  const std::uint64_t found = index.episodes.size() + index.failures.size();
  if (found == shard.episodes) return "";
  return std::to_string(found) + " episodes, planned " + std::to_string(shard.episodes);
}

DatasetProvenance ReadProvenance(const fs::path& folder) {
  const fs::path path = folder / "provenance.json";
  return ProvenanceFromJson(ReadJsonFile(path), path.string());
}

void BeginDataset(FileSystem& files, const fs::path& folder, const std::string& config_text,
                  const DatasetProvenance& provenance) {
  files.CreateFolder(folder);
  CommitConfig(files, folder / "config.yaml", config_text);
  CommitUnlessSame(files, folder / "provenance.json", RecordText(ProvenanceToJson(provenance)));
  for (const char* split : {"train", "val"})
    CommitUnlessSame(files, folder / "splits" / (std::string(split) + ".txt"),
                     SplitLines(provenance, split));
}

void FinishDataset(FileSystem& files, const fs::path& folder) {
  const DatasetProvenance provenance = ReadProvenance(folder);
  const std::vector<ExpectedShard> shards = ExpectedShards(provenance);
  RequireAllShards(folder, provenance, shards);
  const DatasetRecord record = SummarizeShards(folder);
  CommitUnlessSame(files, folder / "failures.jsonl", FailureLines(folder, shards));
  CommitUnlessSame(files, folder / "README.md", DatasetCard(record, provenance));
  CommitUnlessSame(files, folder / "dataset.json", RecordText(DatasetToJson(record)));
}

}  // namespace doorforge
