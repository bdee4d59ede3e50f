// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/verify_dataset.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <set>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/picture_streams.h"
#include "doorforge/schemas/policy.h"

#include "verify_records.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using internal::Append;
using internal::CheckRecords;
using internal::Findings;

constexpr const char* kCollectAgain = "delete the shard's index and give the datagen command again";

std::string Text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

bool AllFinite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

// Largest deviation from what two rows of a rotation matrix obey, over all actions.
double RotationError(std::span<const float> action) {
  double worst = 0;
  for (std::size_t i = 0; i + 9 <= action.size(); i += 9) {
    const Eigen::Vector3d a(action[i + 3], action[i + 4], action[i + 5]);
    const Eigen::Vector3d b(action[i + 6], action[i + 7], action[i + 8]);
    worst =
        std::max({worst, std::fabs(a.norm() - 1), std::fabs(b.norm() - 1), std::fabs(a.dot(b))});
  }
  return worst;
}

double QuaternionError(std::span<const float> proprio) {
  double worst = 0;
  for (std::size_t i = 0; i + 32 <= proprio.size(); i += 32) {
    const Eigen::Vector4d q(proprio[i + 28], proprio[i + 29], proprio[i + 30], proprio[i + 31]);
    worst = std::max(worst, std::fabs(q.norm() - 1));
  }
  return worst;
}

class EpisodeCheck {
 public:
  EpisodeCheck(const ShardReader& reader, std::size_t episode)
      : reader_(reader), episode_(episode) {}

  Findings Run() {
    try {
      CheckArrays(ViewEpisode(reader_, episode_));
      CheckMeta(ReadEpisodeMeta(reader_, episode_));
      PictureFeaturesOf(reader_, episode_);  // throws on what is none
    } catch (const Error& error) {
      Add("DST005", "", error.what(), "arrays as in dataset.json", kCollectAgain);
    }
    return std::move(findings_);
  }

 private:
  void Add(const std::string& code, const std::string& member, const std::string& measured,
           const std::string& allowed, const std::string& fix) {
    findings_.push_back({code, reader_.Describe(episode_, member), measured, allowed, fix});
  }

  void CheckArrays(const EpisodeArrays& arrays) {
    const std::uint64_t indexed = reader_.index().episodes[episode_].decisions;
    if (arrays.decisions != indexed)
      Add("DST005", "label.npy", std::to_string(arrays.decisions) + " decisions",
          std::to_string(indexed) + ", as in the index", kCollectAgain);
    const std::pair<const char*, std::span<const float>> columns[] = {
        {"action.npy", arrays.action},     {"cloud.npy", arrays.cloud},
        {"executed.npy", arrays.executed}, {"joints.npy", arrays.joints},
        {"proprio.npy", arrays.proprio},   {"score.npy", arrays.score}};
    for (const auto& [member, values] : columns) {
      if (!AllFinite(values))
        Add("DST006", member, "a number that is not finite", "finite numbers", kCollectAgain);
    }
    const std::uint8_t label = *std::max_element(arrays.label.begin(), arrays.label.end());
    if (label >= kPointLabelCount)
      Add("DST006", "label.npy", "label " + std::to_string(label), "0 to 4", kCollectAgain);
    for (const auto& [member, values] : {columns[0], columns[2]}) {
      const double rotation = RotationError(values);
      if (!(rotation < 1e-4))
        Add("DST006", member, "rotation rows off by " + Text(rotation), "1e-4", kCollectAgain);
    }
    const double quaternion = QuaternionError(arrays.proprio);
    if (!(quaternion < 1e-4))
      Add("DST006", "proprio.npy", "quaternion's norm off by " + Text(quaternion), "1e-4",
          kCollectAgain);
  }

  void CheckMeta(const nlohmann::ordered_json& meta) {
    const Episode episode = EpisodeFromMeta(meta, reader_.Describe(episode_, "meta.json"));
    const std::uint64_t decisions = reader_.index().episodes[episode_].decisions;
    const bool keeps_failed = reader_.index().header.stage == NameOf(Stage::kGrasp);
    if (episode.outcome != EpisodeOutcome::kOpened && !keeps_failed)
      Add("DST007", "meta.json", "outcome " + std::string(NameOf(episode.outcome)), "opened",
          kCollectAgain);
    if (episode.decisions.size() != decisions)
      Add("DST007", "meta.json", std::to_string(episode.decisions.size()) + " decision times",
          std::to_string(decisions), kCollectAgain);
  }

  const ShardReader& reader_;
  std::size_t episode_;
  Findings findings_;
};

// The faults of a shard that cannot even be opened: how much of it is left.
DatasetFinding UnreadableShard(const fs::path& index_path, const Error& error) {
  const std::string name = index_path.filename().string();
  const fs::path tar =
      index_path.parent_path() / (name.substr(0, name.find(".index.json")) + ".tar");
  std::string measured = error.what();
  if (fs::is_regular_file(tar))
    measured += "; " + std::to_string(RecoverShard(tar).index.episodes.size()) +
                " episodes are still complete in the tar";
  return {"DST002", index_path.string(), measured, "an index and the tar it describes",
          kCollectAgain};
}

Findings CheckShard(const fs::path& index_path) {
  Findings findings;
  try {
    const ShardReader reader(index_path);
    for (const std::string& fault : reader.FindFaults()) {
      const std::size_t colon = std::min(fault.find(": "), fault.size());
      findings.push_back({"DST003", fault.substr(0, colon),
                          fault.substr(std::min(colon + 2, fault.size())),
                          "the bytes that were written", kCollectAgain});
    }
    if (!findings.empty()) return findings;
    for (std::size_t i = 0; i < reader.index().episodes.size(); ++i)
      Append(findings, EpisodeCheck(reader, i).Run());
  } catch (const Error& error) {
    findings.push_back(UnreadableShard(index_path, error));
  }
  return findings;
}

// Index files below the folder, and tars that no index belongs to.
struct ShardFiles {
  std::vector<fs::path> indices;
  Findings orphans;
};

ShardFiles FindShards(const fs::path& folder) {
  std::set<fs::path> indices;
  std::set<fs::path> tars;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("shard-")) continue;
    if (name.ends_with(".index.json")) indices.insert(entry.path());
    if (name.ends_with(".tar")) tars.insert(entry.path());
  }
  ShardFiles files{{indices.begin(), indices.end()}, {}};
  for (const fs::path& tar : tars) {
    const fs::path index = tar.parent_path() / (tar.stem().string() + ".index.json");
    if (indices.count(index) != 0) continue;
    files.orphans.push_back({"DST004", tar.string(),
                             "no index; " +
                                 std::to_string(RecoverShard(tar).index.episodes.size()) +
                                 " complete episodes in the tar",
                             "an index beside every tar",
                             "give the datagen command again: it goes on with unfinished shards"});
  }
  return files;
}

void RequireFolder(const fs::path& folder) {
  if (!fs::is_directory(folder))
    throw Error(ErrorCode::kMissing, folder.string() + ": no such folder");
}

}  // namespace

std::size_t CountShards(const fs::path& folder) {
  RequireFolder(folder);
  std::size_t count = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error))
    count += it->path().filename().string().ends_with(".index.json") ? 1 : 0;
  return count;
}

std::vector<DatasetFinding> VerifyDataset(const VerifyRequest& request) {
  RequireFolder(request.folder);
  ShardFiles files = FindShards(request.folder);
  std::vector<Findings> by_shard(files.indices.size());
  ParallelFor(files.indices.size(), request.threads, [&](std::size_t i) {
    by_shard[i] = CheckShard(files.indices[i]);
    if (request.on_shard) request.on_shard();
  });
  Findings findings;
  for (Findings& shard : by_shard) Append(findings, std::move(shard));
  const bool shards_are_whole = findings.empty();
  Append(findings, std::move(files.orphans));
  Append(findings, CheckRecords(request.folder, files.indices, shards_are_whole));
  return findings;
}

bool AnyFault(const std::vector<DatasetFinding>& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const DatasetFinding& finding) {
    return finding.severity == DatasetSeverity::kError;
  });
}

nlohmann::ordered_json FindingsToJson(const std::vector<DatasetFinding>& findings) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::map<std::string, int> counts;
  for (const DatasetFinding& finding : findings) {
    ++counts[finding.code];
    list.push_back({{"code", finding.code},
                    {"severity", finding.severity == DatasetSeverity::kNote ? "note" : "error"},
                    {"where", finding.where},
                    {"measured", finding.measured},
                    {"allowed", finding.allowed},
                    {"fix", finding.fix}});
  }
  return {{"schema", "doorforge.dataset_findings"},
          {"schema_version", 1},
          {"findings", list},
          {"counts", counts}};
}

std::string FindingsText(const std::vector<DatasetFinding>& findings, const fs::path& folder) {
  std::string text;
  std::size_t faults = 0;
  for (const DatasetFinding& finding : findings) {
    if (finding.severity == DatasetSeverity::kNote) {
      text += "note    " + finding.where + ": " + finding.measured + "\n";
      continue;
    }
    ++faults;
    text += finding.code + "  " + finding.where + "\n        found   " + finding.measured +
            "\n        allowed " + finding.allowed + "\n        fix     " + finding.fix + "\n";
  }
  return text + folder.string() + ": " +
         (faults == 0 ? "no faults" : std::to_string(faults) + " faults") + "\n";
}

}  // namespace doorforge
