// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "verify_records.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/dataset/dataset_card.h"
#include "doorforge/schemas/dataset.h"

#include "dataset_records.h"
#include "record_sums.h"

namespace doorforge::internal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kWriteAnew =
    "give the datagen command again, or dataset merge: they write the records anew";
constexpr const char* kCardAnew =
    "`doorforge dataset card` writes it anew with --overwrite, or with --keep-readme takes a "
    "README.md of your own as it is";

// No part of one role on two sides, at whatever size.
Findings CheckSplits(const std::string& path, std::span<const DatasetDoor> doors,
                     PartIdentity DatasetDoor::*role) {
  Findings findings;
  std::vector<const DatasetDoor*> firsts;  // one door for each part and split
  for (const DatasetDoor& door : doors) {
    const PartIdentity& part = door.*role;
    const auto shares = [&](const DatasetDoor* known) { return part.SameAs(known->*role); };
    const auto on_other_side = std::find_if(firsts.begin(), firsts.end(), [&](const auto* known) {
      return known->split != door.split && shares(known);
    });
    if (on_other_side != firsts.end())
      findings.push_back(
          {"DST009", path + ": " + door.id,
           part.id + " is in " + door.split + " and, as " + ((*on_other_side)->*role).id + " of " +
               (*on_other_side)->id + ", in " + (*on_other_side)->split,
           "each part on one side, at whatever size", "collect anew with a split by parts"});
    const bool listed = std::any_of(firsts.begin(), firsts.end(), [&](const auto* known) {
      return known->split == door.split && (known->*role).sha256 == part.sha256;
    });
    if (!listed) firsts.push_back(&door);
  }
  return findings;
}

// How two texts differ, for a finding.
std::string DifferenceOf(const std::string& found, const std::string& expected) {
  const auto [at, unused] =
      std::mismatch(found.begin(), found.end(), expected.begin(), expected.end());
  const auto line = 1 + std::count(found.begin(), at, '\n');
  return "differs from byte " + std::to_string(at - found.begin()) + " on (line " +
         std::to_string(line) + "), " + std::to_string(found.size()) + " bytes";
}

class RecordCheck {
 public:
  RecordCheck(const fs::path& folder, const std::vector<fs::path>& indices, bool shards_are_whole)
      : folder_(folder), index_paths_(indices), shards_are_whole_(shards_are_whole) {}

  Findings Run() {
    ReadIndices();
    Try(kProvenanceRecord, [&] { ReadProvenanceRecord(); });
    Try(kDatasetRecord, [&] { ReadDatasetRecord(); });
    Try(RecordSums::kFileName, [&] { ReadSums(); });
    Try(kConfigRecord, [&] { CheckConfig(); });
    if (provenance_) CheckByProvenance();
    Try(kFailuresRecord, [&] { CheckFailures(); });
    if (dataset_) Try(kDatasetRecord, [&] { CheckDataset(); });
    Try(kReadmeRecord, [&] { CheckReadme(); });
    Try(kCroissantRecord, [&] { CheckCroissant(); });
    if (sums_) CheckSums();
    NameOthers();
    return std::move(findings_);
  }

 private:
  void Add(const std::string& code, const std::string& record, const std::string& measured,
           const std::string& allowed, const std::string& fix = kWriteAnew) {
    faulty_.insert(record);
    findings_.push_back({code, (folder_ / record).string(), measured, allowed, fix});
  }

  void Note(const std::string& file, const std::string& measured, const std::string& allowed) {
    findings_.push_back({"DST013", (folder_ / file).string(), measured, allowed,
                         "nothing, if it is yours", DatasetSeverity::kNote});
  }

  // What cannot be read is a finding of its record, and the others are checked all the same.
  void Try(const std::string& record, const std::function<void()>& check) {
    try {
      check();
    } catch (const Error& error) {
      Add("DST001", record, error.what(), "a record that can be read");
    }
  }

  bool IsThere(const std::string& record) const { return fs::is_regular_file(folder_ / record); }

  std::string TextOf(const std::string& record) const { return ReadFile(folder_ / record); }

  bool IsListed(const std::string& record) const { return sums_ && sums_->Has(record); }

  bool IsAsListed(const std::string& record) const {
    return sums_ && sums_->Lists(record, TextOf(record));
  }

  void Compare(const std::string& record, const std::string& expected, const std::string& from) {
    const std::string found = TextOf(record);
    if (found != expected) Add("DST012", record, DifferenceOf(found, expected), from);
  }

  // One that cannot be read has a finding already.
  void ReadIndices() {
    for (const fs::path& path : index_paths_) {
      try {
        indices_.push_back(ReadShardIndex(path));
      } catch (const Error&) {
        all_indices_ = false;
      }
    }
  }

  void ReadProvenanceRecord() {
    const fs::path path = folder_ / kProvenanceRecord;
    provenance_ = ProvenanceFromJson(ReadJsonFile(path), path.string());
  }

  // Without it the dataset is unfinished, and then there need be no more than what is known before
  // the first episode.
  void ReadDatasetRecord() {
    if (!IsThere(kDatasetRecord)) {
      Add("DST001", kDatasetRecord, "missing", "present: it is written last, so this is unfinished",
          "give the datagen command again, or all its tasks and dataset merge");
      return;
    }
    dataset_ = ReadDataset(folder_);
  }

  void ReadSums() {
    if (!fs::exists(fs::symlink_status(folder_ / RecordSums::kFileName))) return;
    sums_ = RecordSums::Read(folder_);
  }

  // All indices hold it; provenance.json is one more witness.
  std::string ConfigHash() const {
    std::set<std::string> hashes;
    for (const ShardIndex& index : indices_) hashes.insert(index.header.config_sha256);
    if (hashes.size() == 1) return *hashes.begin();
    return provenance_ ? provenance_->config_sha256 : "";
  }

  void CheckConfig() {
    const std::string found = Sha256Hex(TextOf(kConfigRecord));
    const std::string expected = ConfigHash();
    if (!expected.empty() && found != expected)
      Add("DST012", kConfigRecord, "SHA-256 " + found.substr(0, 12) + "...",
          expected.substr(0, 12) + "... as in the shards' indices and provenance.json",
          "take it from a copy of the dataset, or collect anew");
  }

  void CheckByProvenance() {
    if (provenance_->config_sha256 != ConfigHash())
      Add("DST012", kProvenanceRecord, "config_sha256 " + provenance_->config_sha256.substr(0, 12),
          ConfigHash().substr(0, 12) + " as in the shards' indices");
    Try(kProvenanceRecord, [&] { CheckForm(); });
    for (const char* split : kSplitNames) {
      const std::string record = SplitRecord(split);
      Try(record, [&] {
        Compare(record, SplitText(*provenance_, split), "the doors that provenance.json names");
      });
    }
    Try(kProvenanceRecord, [&] { CheckPlan(); });
    const std::string path = (folder_ / kProvenanceRecord).string();
    Append(findings_, CheckSplits(path, provenance_->doors, &DatasetDoor::body));
    Append(findings_, CheckSplits(path, provenance_->doors, &DatasetDoor::handle));
  }

  // Without a list of hashes: its text is at least one that a writer makes.
  void CheckForm() {
    if (IsListed(kProvenanceRecord) || provenance_->planned.empty()) return;
    if (TextOf(kProvenanceRecord) == EarlierProvenanceText(*provenance_)) return;
    Compare(kProvenanceRecord, ProvenanceText(*provenance_), "its own content as writers put it");
  }

  // Every planned shard is there with all its episodes.
  void CheckPlan() {
    for (const ExpectedShard& shard : ExpectedShards(*provenance_)) {
      const std::string fault = PlanFaultOf(folder_, shard, ConfigHash());
      if (!fault.empty())
        findings_.push_back({"DST010", (folder_ / shard.Name()).string(), fault,
                             std::to_string(shard.episodes) + " episodes as planned",
                             "give the datagen command again"});
    }
  }

  void CheckFailures() {
    if (!dataset_ && !IsThere(kFailuresRecord)) return;
    if (all_indices_)
      Compare(kFailuresRecord, FailuresText(indices_), "the failures in the shards' indices");
  }

  void CheckDataset() {
    CheckCounts();
    if (!shards_are_whole_ || !faulty_counts_.empty()) return;
    // other builds describe the features in other words: those are compared by their names here,
    // and as a text with SHA256SUMS
    const Json found = ReadJsonFile(folder_ / kDatasetRecord);
    Json expected = DatasetToJson(SummarizeShards(folder_));
    const Json& features = MemberOf(found, "features", kDatasetRecord);
    CheckFeatures(features, expected["features"]);
    expected["features"] = features;
    Compare(kDatasetRecord, JsonText(expected, 2) + "\n",
            "the counts and statistics of the shards");
  }

  // Each is one of this build, in everything that a reader goes by.
  void CheckFeatures(const Json& features, const Json& known) {
    for (const Json& feature : features) {
      const auto is_same = [&](const Json& other) {
        return feature.is_object() && feature.size() == other.size() &&
               std::all_of(other.items().begin(), other.items().end(), [&](const auto& field) {
                 const bool is_prose =
                     field.key() == "unit" || field.key() == "frame" || field.key() == "meaning";
                 return feature.contains(field.key()) &&
                        (is_prose ? feature[field.key()].is_string()
                                  : feature[field.key()] == field.value());
               });
      };
      if (!std::any_of(known.begin(), known.end(), is_same))
        Add("DST012", kDatasetRecord, "features: one that no episode has",
            "name, member, dtype and shape of the arrays in the shards");
    }
  }

  // Part by part: what dataset.json counts against what the indices count.
  void CheckCounts() {
    std::map<std::pair<std::string, std::string>, DatasetPart> counted;
    for (const ShardIndex& index : indices_) {
      DatasetPart& part = counted[{index.header.stage, index.header.split}];
      ++part.shards;
      part.episodes += index.episodes.size();
      part.failed_episodes += index.failures.size();
      for (const ShardEpisode& episode : index.episodes) part.decisions += episode.decisions;
    }
    for (const DatasetPart& part : dataset_->parts) {
      const DatasetPart& found = counted[{part.stage, part.split}];
      if (found.shards == part.shards && found.episodes == part.episodes &&
          found.failed_episodes == part.failed_episodes && found.decisions == part.decisions)
        continue;
      faulty_counts_ = part.stage + "/" + part.split;
      findings_.push_back({"DST008", (folder_ / kDatasetRecord).string(),
                           faulty_counts_ + ": " + std::to_string(part.shards) + " shards, " +
                               std::to_string(part.episodes) + " episodes, " +
                               std::to_string(part.failed_episodes) + " failed, " +
                               std::to_string(part.decisions) + " decisions",
                           std::to_string(found.shards) + ", " + std::to_string(found.episodes) +
                               ", " + std::to_string(found.failed_episodes) + ", " +
                               std::to_string(found.decisions) + " as in the shards",
                           kWriteAnew});
    }
  }

  // Where a dataset has no list of hashes it is a card of ours, or a user's.
  void CheckReadme() {
    if (!IsThere(kReadmeRecord)) {
      if (dataset_) Add("DST001", kReadmeRecord, "missing", "present");
      return;
    }
    if (IsListed(kReadmeRecord)) return;  // see CheckSums()
    if (sums_ || !dataset_ || !provenance_) return;
    const std::string found = TextOf(kReadmeRecord);
    if (!ShortCards(*dataset_, *provenance_).contains(found) &&
        found != MakeDatasetCard(folder_).readme)
      Note(kReadmeRecord, "none that this build writes, and the dataset has no SHA256SUMS",
           "a README.md of your own, or of another build");
  }

  void CheckCroissant() {
    if (!IsThere(kCroissantRecord) || IsListed(kCroissantRecord)) return;
    if (sums_ || !dataset_ || !provenance_) return;
    if (TextOf(kCroissantRecord) != JsonText(MakeDatasetCard(folder_).croissant, 2) + "\n")
      Note(kCroissantRecord, "none that this build writes, and the dataset has no SHA256SUMS",
           "a croissant.json of another build");
  }

  void CheckSums() {
    for (const auto& [record, sha256] : sums_->sums()) {
      if (IsFixed(record)) Try(record, [&, name = record, sum = sha256] { CheckSum(name, sum); });
    }
    for (const std::string& record : Records()) {
      if (dataset_ && IsThere(record) && !sums_->Has(record))
        Add("DST012", record, std::string("not in ") + RecordSums::kFileName, "listed there",
            record == kReadmeRecord || record == kCroissantRecord ? kCardAnew : kWriteAnew);
    }
    for (const fs::path& path : index_paths_)
      Try(path.lexically_relative(folder_).string(), [&] { RequireChecksum(path); });
  }

  // Indices are not in the sums, since each has a checksum of its own; builds that wrote none did
  // not write sums.
  void RequireChecksum(const fs::path& path) {
    if (ReadFile(path).find("\"index_crc32c\"") != std::string::npos) return;
    Add("DST012", path.lexically_relative(folder_).string(), "no index_crc32c",
        std::string("a checksum of its own, as beside every ") + RecordSums::kFileName,
        "delete it and give the datagen command again");
  }

  void CheckSum(const std::string& record, const std::string& sha256) {
    if (!IsThere(record)) {
      // what is missing was said, but for a card, which need not be there
      if (record == kCroissantRecord)
        Add("DST001", record, "missing", std::string("present: ") + RecordSums::kFileName,
            kCardAnew);
      return;
    }
    if (faulty_.contains(record) || IsAsListed(record)) return;
    Add("DST012", record, "SHA-256 " + Sha256OfFile(folder_ / record).substr(0, 12) + "...",
        sha256.substr(0, 12) + "... as in " + RecordSums::kFileName,
        record == kReadmeRecord || record == kCroissantRecord ? kCardAnew : kWriteAnew);
  }

  static std::set<std::string> Records() {
    std::set<std::string> records = {kConfigRecord, kProvenanceRecord, kFailuresRecord,
                                     kReadmeRecord, kCroissantRecord,  kDatasetRecord};
    for (const char* split : kSplitNames) records.insert(SplitRecord(split));
    return records;
  }

  // A list says nothing of files that are none of a dataset's.
  static bool IsFixed(const std::string& record) { return Records().contains(record); }

  // Everything that is none of a dataset's files is named, so that nobody takes it for checked.
  void NameOthers() {
    std::set<fs::path> known;
    for (const std::string& record : Records()) known.insert(folder_ / record);
    known.insert(folder_ / RecordSums::kFileName);
    known.insert(folder_ / FolderLock::kFileName);
    for (const fs::path& path : index_paths_) known.insert(path);
    std::set<fs::path> others;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      if (entry.is_directory() && !entry.is_symlink()) continue;
      if (!known.contains(entry.path()) && !IsOfShard(entry.path())) others.insert(entry.path());
    }
    for (const fs::path& path : others)
      Note(path.lexically_relative(folder_).string(), "no part of the dataset; it was not checked",
           "the files in docs/format-shards.md");
  }

  // A tar, which has been checked or is said to have no index, or what an unfinished one has.
  static bool IsOfShard(const fs::path& path) {
    const std::string name = path.filename().string();
    if (name.starts_with("shard-")) return name.ends_with(".tar");
    return name.starts_with(".shard-") &&
           (name.ends_with(".tar.partial") || name.ends_with(".journal"));
  }

  const fs::path& folder_;
  const std::vector<fs::path>& index_paths_;
  bool shards_are_whole_;
  std::vector<ShardIndex> indices_;
  bool all_indices_ = true;
  std::optional<DatasetProvenance> provenance_;
  std::optional<DatasetRecord> dataset_;
  std::optional<RecordSums> sums_;
  std::set<std::string> faulty_;  // records with a finding
  std::string faulty_counts_;     // a part of dataset.json
  Findings findings_;
};

}  // namespace

Findings CheckRecords(const fs::path& folder, const std::vector<fs::path>& indices,
                      bool shards_are_whole) {
  return RecordCheck(folder, indices, shards_are_whole).Run();
}

}  // namespace doorforge::internal
