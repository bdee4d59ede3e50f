// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "dataset_records.h"

#include <algorithm>
#include <set>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_difference.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"

#include "record_sums.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void CompareConfig(const fs::path& path, const std::string& text) {
  const std::string there = ReadFile(path);
  if (there == text) return;
  throw Error(ErrorCode::kInvalidArgument, path.string() +
                                               ": the folder holds episodes of another config; "
                                               "give the recorded settings to go on, another "
                                               "--out, or --overwrite to begin anew" +
                                               ConfigDifference(there, text));
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

std::vector<ShardIndex> IndicesOf(const fs::path& folder,
                                  const std::vector<ExpectedShard>& shards) {
  std::vector<ShardIndex> indices;
  for (const ExpectedShard& shard : shards)
    indices.push_back(ReadShardIndex(IndexPathOf(folder, shard)));
  return indices;
}

// The line of a record that this does not write: as it was listed, or as it is there.
void KeepSum(const RecordSums& known, const fs::path& folder, const std::string& record,
             RecordSums& sums) {
  if (!fs::is_regular_file(folder / record)) return;
  sums.SetHash(record, known.Has(record) ? known.sums().at(record) : Sha256OfFile(folder / record));
}

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
  const fs::path path = folder / kProvenanceRecord;
  const RecordSums sums = RecordSums::ReadOrEmpty(folder);
  if (sums.Has(kProvenanceRecord) && !sums.Lists(kProvenanceRecord, ReadFile(path)))
    throw Error(ErrorCode::kFormat, path.string() + ": SHA-256 is not the one in " +
                                        RecordSums::kFileName +
                                        "; give the datagen command again, which writes it anew");
  return ProvenanceFromJson(ReadJsonFile(path), path.string());
}

std::string SplitRecord(const std::string& split) { return "splits/" + split + ".txt"; }

// Ids of the doors of one split, sorted, one a line.
std::string SplitText(const DatasetProvenance& provenance, const std::string& split) {
  std::set<std::string> ids;
  for (const DatasetDoor& door : provenance.doors) {
    if (door.split == split) ids.insert(door.id);
  }
  std::string lines;
  for (const std::string& id : ids) lines += id + "\n";
  return lines;
}

std::string FailuresText(std::span<const ShardIndex> indices) {
  std::string lines;
  for (const ShardIndex& index : indices) {
    const DatasetPart part{index.header.stage, index.header.split, 0, 0, 0, 0, 0};
    for (const FailedEpisode& failure : index.failures) lines += FailureLine(failure, part) + "\n";
  }
  return lines;
}

std::string DatasetText(const DatasetRecord& record) {
  return JsonText(DatasetToJson(record), 2) + "\n";
}

// A door a line: with a number of its shapes a line it would be three times as long.
std::string ProvenanceText(const DatasetProvenance& provenance) {
  Json json = ProvenanceToJson(provenance);
  const Json doors = json["doors"];
  json.erase("doors");
  std::string text = JsonText(json, 2);
  text.resize(text.size() - std::string_view("\n}").size());
  text += ",\n  \"doors\": [";
  for (std::size_t i = 0; i < doors.size(); ++i)
    text += (i > 0 ? ",\n    " : "\n    ") + JsonText(doors[i]);
  return text + (doors.empty() ? "]\n}\n" : "\n  ]\n}\n");
}

std::string EarlierProvenanceText(const DatasetProvenance& provenance) {
  return JsonText(ProvenanceToJson(provenance), 2) + "\n";
}

std::set<std::string> ShortCards(const DatasetRecord& record, const DatasetProvenance& provenance) {
  const std::string card = DatasetCard(record, provenance);
  // the first builds called the reader by another name
  const std::string now = "doorforge_reader.py";
  std::string earlier = card;
  const std::size_t at = card.find(now);
  if (at != std::string::npos) earlier.replace(at, now.size(), "doorforge_shards.py");
  return {card, earlier};
}

void BeginDataset(FileSystem& files, const fs::path& folder, const std::string& config_text,
                  const DatasetProvenance& provenance) {
  files.CreateFolder(folder);
  CommitConfig(files, folder / kConfigRecord, config_text);
  RecordSums sums = RecordSums::ReadOrEmpty(folder);
  sums.Set(kConfigRecord, config_text);
  const auto commit = [&](const std::string& record, const std::string& text) {
    CommitUnlessSame(files, folder / record, text);
    sums.Set(record, text);
  };
  commit(kProvenanceRecord, ProvenanceText(provenance));
  for (const char* split : kSplitNames) commit(SplitRecord(split), SplitText(provenance, split));
  sums.Commit(files, folder);
}

void FinishDataset(FileSystem& files, const fs::path& folder) {
  const DatasetProvenance provenance = ReadProvenance(folder);
  const std::vector<ExpectedShard> shards = ExpectedShards(provenance);
  RequireAllShards(folder, provenance, shards);
  const DatasetRecord record = SummarizeShards(folder);
  const std::string dataset = DatasetText(record);
  const std::string failures = FailuresText(IndicesOf(folder, shards));
  CommitUnlessSame(files, folder / kFailuresRecord, failures);
  if (!fs::exists(folder / kReadmeRecord))
    CommitFile(files, folder / kReadmeRecord, DatasetCard(record, provenance));
  const RecordSums known = RecordSums::ReadOrEmpty(folder);
  RecordSums sums;
  sums.SetHash(kConfigRecord, provenance.config_sha256);
  for (const char* split : kSplitNames) sums.Set(SplitRecord(split), SplitText(provenance, split));
  for (const char* kept : {kProvenanceRecord, kReadmeRecord, kCroissantRecord})
    KeepSum(known, folder, kept, sums);
  sums.Set(kFailuresRecord, failures);
  sums.Set(kDatasetRecord, dataset);
  sums.Commit(files, folder);
  CommitUnlessSame(files, folder / kDatasetRecord, dataset);
}

}  // namespace doorforge
