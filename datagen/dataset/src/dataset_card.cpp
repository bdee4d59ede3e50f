// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/dataset/dataset_card.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <map>
#include <set>
#include <vector>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/dataset.h"

#include "dataset_records.h"
#include "record_sums.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// What both files are made from.
struct Contents {
  fs::path folder;
  Json record;  // dataset.json
  DatasetRecord dataset;
  DatasetProvenance provenance;
  std::map<std::string, std::vector<ShardIndex>> shards;  // by "stage/split"
};

std::string NameOfPart(const DatasetPart& part) { return part.stage + "/" + part.split; }

Contents ReadContents(const fs::path& folder) {
  Contents contents;
  contents.folder = folder;
  contents.dataset = ReadDataset(folder);
  contents.record = ReadJsonFile(folder / "dataset.json");
  const fs::path provenance = folder / "provenance.json";
  contents.provenance = ProvenanceFromJson(ReadJsonFile(provenance), provenance.string());
  for (const DatasetPart& part : contents.dataset.parts) {
    std::vector<ShardIndex>& indices = contents.shards[NameOfPart(part)];
    for (const fs::path& path : ShardIndices(folder, part.stage, part.split))
      indices.push_back(ReadShardIndex(path));
  }
  return contents;
}

std::set<std::string> LicensesOf(const DatasetProvenance& provenance) {
  std::set<std::string> licenses;
  for (const DatasetDoor& door : provenance.doors) licenses.insert(door.license);
  return licenses;
}

std::string LowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string Joined(const std::set<std::string>& texts, const std::string& separator) {
  std::string joined;
  for (const std::string& text : texts) joined += (joined.empty() ? "" : separator) + text;
  return joined;
}

std::uint64_t DecisionsOf(const DatasetRecord& record) {
  std::uint64_t decisions = 0;
  for (const DatasetPart& part : record.parts) decisions += part.decisions;
  return decisions;
}

// The hub's classes of size, by samples.
std::string SizeCategory(std::uint64_t samples) {
  if (samples < 1000) return "n<1K";
  if (samples < 10000) return "1K<n<10K";
  if (samples < 100000) return "10K<n<100K";
  if (samples < 1000000) return "100K<n<1M";
  return samples < 10000000 ? "1M<n<10M" : "10M<n<100M";
}

// One configuration a stage; the hub loads tars in WebDataset naming by themselves.
std::string ConfigurationsOf(const DatasetRecord& record) {
  std::map<std::string, std::vector<std::string>> stages;
  for (const DatasetPart& part : record.parts)
    if (part.episodes > 0) stages[part.stage].push_back(part.split);
  std::string text = stages.empty() ? "" : "configs:\n";
  for (const auto& [stage, splits] : stages) {
    text += "- config_name: " + stage + "\n  data_files:\n";
    for (const std::string& split : splits)
      text += "  - split: " + split + "\n    path: " + stage + "/" + split + "/*.tar\n";
  }
  return text;
}

std::string FrontMatter(const Contents& contents) {
  const std::set<std::string> licenses = LicensesOf(contents.provenance);
  std::string text = "---\npretty_name: Door episodes\n";
  if (licenses.size() == 1) {
    text += "license: " + LowerCase(*licenses.begin()) + "\n";
  } else {
    text += "license: other\nlicense_name: \"" + Joined(licenses, ", ") + "\"\n";
  }
  return text +
         "task_categories:\n- robotics\ntags:\n- robotics\n- manipulation\n"
         "- articulated-objects\n- point-clouds\n- simulation\n- webdataset\nsize_categories:\n- " +
         SizeCategory(DecisionsOf(contents.dataset)) + "\n" + ConfigurationsOf(contents.dataset) +
         "---\n";
}

std::string PartTable(const DatasetRecord& record) {
  std::string text =
      "| stage | split | episodes | failed | decisions | shards | MiB |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const DatasetPart& part : record.parts) {
    char mebibytes[32];
    std::snprintf(mebibytes, sizeof mebibytes, "%.1f", static_cast<double>(part.bytes) / (1 << 20));
    text += "| " + part.stage + " | " + part.split + " | " + std::to_string(part.episodes) + " | " +
            std::to_string(part.failed_episodes) + " | " + std::to_string(part.decisions) + " | " +
            std::to_string(part.shards) + " | " + mebibytes + " |\n";
  }
  return text;
}

std::string ShapeText(const Json& shape) {
  std::string text;
  for (const Json& length : shape)
    text += (text.empty() ? "" : " x ") +
            (length.is_string() ? length.get<std::string>() : JsonText(length));
  return text;
}

std::string FeatureTable(const Json& record) {
  std::string text =
      "| array | type | shape | unit | frame | meaning |\n|---|---|---|---|---|---|\n";
  for (const Json& feature : record.at("features")) {
    std::string type = feature.at("dtype").get<std::string>();
    if (type.starts_with('|')) type.insert(0, 1, '\\');
    text += "| `" + feature.at("name").get<std::string>() + "` | " + type + " | " +
            ShapeText(feature.at("shape")) + " | " + feature.at("unit").get<std::string>() + " | " +
            feature.at("frame").get<std::string>() + " | " +
            feature.at("meaning").get<std::string>() + " |\n";
  }
  return text;
}

std::string DoorTable(const DatasetProvenance& provenance) {
  std::map<std::pair<std::string, std::string>, std::map<std::string, int>> kinds;
  std::set<std::string> splits;
  for (const DatasetDoor& door : provenance.doors) {
    ++kinds[{door.category, door.mechanism}][door.split];
    splits.insert(door.split);
  }
  std::string text = "| category | mechanism |";
  std::string rule = "|---|---|";
  for (const std::string& split : splits) {
    text += " doors of " + split + " |";
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (auto& [kind, counts] : kinds) {
    text += "| " + kind.first + " | " + kind.second + " |";
    for (const std::string& split : splits) text += " " + std::to_string(counts[split]) + " |";
    text += "\n";
  }
  return text;
}

std::string CauseTable(const Contents& contents) {
  std::map<std::string, int> causes;
  for (const auto& [part, indices] : contents.shards)
    for (const ShardIndex& index : indices)
      for (const FailedEpisode& failure : index.failures) ++causes[failure.outcome];
  if (causes.empty()) return "No planned episode failed.\n";
  std::string text = "| cause | planned episodes |\n|---|---|\n";
  for (const auto& [cause, count] : causes)
    text += "| " + cause + " | " + std::to_string(count) + " |\n";
  return text;
}

std::string ReadmeOf(const Contents& contents) {
  const DatasetProvenance& provenance = contents.provenance;
  return FrontMatter(contents) +
         "\n# Door episodes\n\n"
         "A mobile Franka opens latched doors in simulation. Every decision point, one in 1/6 s, "
         "holds the point cloud that a depth camera sees, with all that hides in it, what the "
         "robot feels of itself, and what was asked of the hand next. Units are SI and radians.\n\n"
         "## What is in it\n\n" +
         PartTable(contents.dataset) + "\n" + FeatureTable(contents.record) +
         "\n`dataset.json` holds the mean, standard deviation, minimum and maximum of every "
         "component over the train split. `meta.json` of every episode holds its outcome, scene, "
         "seed, camera, door and the policies that acted.\n\n## Doors\n\n" +
         DoorTable(provenance) +
         "\nNo body and no handle is on both sides of a split. `provenance.json` names every "
         "door with its hash and licence. Licences of the parts: " +
         Joined(LicensesOf(provenance), ", ") + ".\n\n## Planned episodes that failed\n\n" +
         CauseTable(contents) +
         "\n`failures.jsonl` holds each of them with its numbers.\n\n"
         "## How it was made\n\ndoorforge " +
         provenance.code_version + ", seed " + std::to_string(provenance.seed) +
         ", configuration SHA-256 `" + provenance.config_sha256 +
         "` (`config.yaml`). The same doors, seed and configuration give the same bytes.\n\n"
         "## How to read it\n\n"
         "The shards are plain tar files of .npy arrays with a JSON index beside each, which holds "
         "the offset, size and CRC-32C of every member. `doorforge_reader.py`, one file over "
         "numpy, reads them by index; WebDataset and Hugging Face `datasets` read the tars.\n\n"
         "```python\nimport doorforge_reader\n\ndata = doorforge_reader.Dataset(\"DIR\")\n"
         "for episode in data.episodes(\"open\", \"train\"):\n"
         "    clouds, actions = episode[\"cloud\"], episode[\"action\"]\n```\n\n"
         "## What it is not\n\n"
         "Everything is simulated: rigid doors, idealised friction and latches, depth without "
         "colour. Nothing was recorded from people or real rooms.\n";
}

// --- Croissant -------------------------------------------------------------------------------

Json Reference(const std::string& id) { return {{"@id", id}}; }

Json CroissantContext() {
  Json context = {{"@language", "en"},
                  {"@vocab", "https://schema.org/"},
                  {"cr", "http://mlcommons.org/croissant/"},
                  {"dct", "http://purl.org/dc/terms/"},
                  {"rai", "http://mlcommons.org/croissant/RAI/"},
                  {"sc", "https://schema.org/"},
                  {"conformsTo", "dct:conformsTo"},
                  {"data", {{"@id", "cr:data"}, {"@type", "@json"}}},
                  {"dataType", {{"@id", "cr:dataType"}, {"@type", "@vocab"}}},
                  {"examples", {{"@id", "cr:examples"}, {"@type", "@json"}}}};
  for (const char* term : {"citeAs",       "column",        "equivalentProperty",
                           "extract",      "field",         "fileObject",
                           "fileProperty", "fileSet",       "format",
                           "includes",     "jsonPath",      "key",
                           "md5",          "isLiveDataset", "parentField",
                           "path",         "recordSet",     "references",
                           "regex",        "repeated",      "replace",
                           "samplingRate", "separator",     "source",
                           "subField",     "transform"})
    context[term] = std::string("cr:") + term;
  return context;
}

Json FileObject(const std::string& path, std::uint64_t bytes, const std::string& encoding,
                const std::string& sha256) {
  return {{"@type", "cr:FileObject"},
          {"@id", path},
          {"name", path},
          {"contentUrl", path},
          {"contentSize", std::to_string(bytes) + " B"},
          {"encodingFormat", encoding},
          {"sha256", sha256}};
}

// README.md and croissant.json itself cannot be listed: they are written by this.
void AppendRecords(const Contents& contents, Json& distribution) {
  std::vector<std::pair<std::string, std::string>> files = {
      {"dataset.json", "application/json"},
      {"provenance.json", "application/json"},
      {"config.yaml", "application/yaml"},
      {"failures.jsonl", "application/jsonlines"}};
  std::set<std::string> splits;
  if (fs::is_directory(contents.folder / "splits")) {
    for (const auto& entry : fs::directory_iterator(contents.folder / "splits"))
      splits.insert("splits/" + entry.path().filename().string());
  }
  for (const std::string& split : splits) files.emplace_back(split, "text/plain");
  for (const auto& [path, encoding] : files)
    distribution.push_back(FileObject(path, fs::file_size(contents.folder / path), encoding,
                                      Sha256OfFile(contents.folder / path)));
}

void AppendShards(const Contents& contents, const std::string& part, Json& distribution) {
  Json tars = Json::array();
  for (const ShardIndex& index : contents.shards.at(part)) {
    const std::string tar = part + "/" + index.tar;
    const std::string sidecar = part + "/" + ShardStem(index.header.number) + ".index.json";
    distribution.push_back(FileObject(tar, index.tar_bytes, "application/x-tar", index.tar_sha256));
    distribution.push_back(FileObject(sidecar, fs::file_size(contents.folder / sidecar),
                                      "application/json", Sha256OfFile(contents.folder / sidecar)));
    tars.push_back(Reference(tar));
  }
  if (tars.empty()) return;
  const auto add = [&](const std::string& name, const std::string& member,
                       const std::string& encoding, const std::string& description) {
    distribution.push_back({{"@type", "cr:FileSet"},
                            {"@id", part + "/" + name},
                            {"name", part + "/" + name},
                            {"description", description},
                            {"containedIn", tars},
                            {"encodingFormat", encoding},
                            {"includes", "*." + member}});
  };
  add("meta", "meta.json", "application/json", "outcome, scene, seed, camera, door, policies");
  for (const Json& feature : contents.record.at("features"))
    add(feature.at("name"), feature.at("member"), "application/octet-stream",
        "NumPy array " + feature.at("dtype").get<std::string>() + ", " +
            ShapeText(feature.at("shape")) + ", unit '" + feature.at("unit").get<std::string>() +
            "', frame '" + feature.at("frame").get<std::string>() +
            "': " + feature.at("meaning").get<std::string>());
}

// A field of a record set; `extract` says where in the source it is.
Json Field(const std::string& record_set, const std::string& name, const std::string& type,
           Json source) {
  return {{"@type", "cr:Field"},
          {"@id", record_set + "/" + name},
          {"name", record_set + "/" + name},
          {"dataType", type},
          {"source", std::move(source)}};
}

// The whole record as text: readers of the format take single values of JSON from files that lie
// by themselves, not from files in a tar.
Json EpisodeRecords(const std::string& part) {
  const std::string id = part + "/episodes";
  const Json set = Reference(part + "/meta");
  const Json key = {{"fileSet", set},
                    {"extract", {{"fileProperty", "filename"}}},
                    {"transform", {{"regex", "^([^.]+)\\..*$"}}}};
  const Json meta = {{"fileSet", set}, {"extract", {{"fileProperty", "content"}}}};
  return {{"@type", "cr:RecordSet"},
          {"@id", id},
          {"name", id},
          {"description", "one record an episode: its key and its meta.json"},
          {"field",
           Json::array({Field(id, "key", "sc:Text", key), Field(id, "meta", "sc:Text", meta)})}};
}

Json FailureRecords() {
  const std::string id = "failures";
  const Json file = Reference("failures.jsonl");
  Json fields = Json::array();
  const std::vector<std::pair<std::string, std::string>> columns = {
      {"stage", "sc:Text"},           {"split", "sc:Text"},           {"key", "sc:Text"},
      {"door_id", "sc:Text"},         {"outcome", "sc:Text"},         {"detail", "sc:Text"},
      {"peak_hinge_rad", "sc:Float"}, {"peak_handle_rad", "sc:Float"}};
  for (const auto& [name, type] : columns)
    fields.push_back(
        Field(id, name, type, {{"fileObject", file}, {"extract", {{"column", name}}}}));
  return {{"@type", "cr:RecordSet"},
          {"@id", id},
          {"name", id},
          {"description", "planned episodes that failed, with their causes"},
          {"field", fields}};
}

// URLs for the licences that the catalogue uses; others are given by their SPDX name.
Json LicenseOf(const DatasetProvenance& provenance) {
  Json licenses = Json::array();
  for (const std::string& license : LicensesOf(provenance))
    licenses.push_back(license.find(' ') == std::string::npos && !license.starts_with("LicenseRef")
                           ? "https://spdx.org/licenses/" + license + ".html"
                           : license);
  return licenses.size() == 1 ? licenses[0] : licenses;
}

Json CroissantOf(const Contents& contents) {
  Json distribution = Json::array();
  AppendRecords(contents, distribution);
  Json record_sets = Json::array();
  for (const DatasetPart& part : contents.dataset.parts) {
    AppendShards(contents, NameOfPart(part), distribution);
    if (part.episodes > 0) record_sets.push_back(EpisodeRecords(NameOfPart(part)));
  }
  const bool any_failed =
      std::any_of(contents.dataset.parts.begin(), contents.dataset.parts.end(),
                  [](const DatasetPart& part) { return part.failed_episodes > 0; });
  if (any_failed) record_sets.push_back(FailureRecords());
  Json croissant = {{"@context", CroissantContext()},
                    {"@type", "sc:Dataset"},
                    {"name", "door_episodes"},
                    {"description",
                     "A mobile robot opens latched doors in simulation: occluded point clouds, "
                     "proprioception and actions at every decision, made by doorforge " +
                         contents.provenance.code_version + " with seed " +
                         std::to_string(contents.provenance.seed) + "."},
                    {"conformsTo", "http://mlcommons.org/croissant/1.0"},
                    {"license", LicenseOf(contents.provenance)},
                    {"version", std::to_string(kDatasetSchemaVersion) + ".0.0"},
                    {"keywords", Json::array({"robotics", "manipulation", "articulated objects",
                                              "point clouds", "simulation"})},
                    {"distribution", distribution}};
  if (!record_sets.empty()) croissant["recordSet"] = record_sets;
  return croissant;
}

}  // namespace

DatasetCardFiles MakeDatasetCard(const fs::path& folder) {
  const Contents contents = ReadContents(folder);
  return {ReadmeOf(contents), CroissantOf(contents)};
}

namespace {

// Whether a record is one that was written here: it is listed as it is, or is one of the texts.
bool IsOurs(const fs::path& folder, const std::string& record, const RecordSums& sums,
            const std::set<std::string>& texts) {
  if (!fs::exists(fs::symlink_status(folder / record))) return true;
  const std::string content = ReadFile(folder / record);
  return sums.Lists(record, content) || texts.contains(content);
}

[[noreturn]] void RefuseToReplace(const fs::path& file) {
  throw Error(ErrorCode::kInvalidArgument,
              file.string() +
                  ": was written or changed by hand; pass --overwrite to replace it, or "
                  "--keep-readme to leave README.md as it is");
}

}  // namespace

void WriteDatasetCard(const fs::path& folder, OldReadme readme) {
  Require(fs::is_directory(folder), ErrorCode::kMissing, folder.string() + ": no such folder");
  const FolderLock lock(folder, "doorforge dataset card", Writers::kOne);
  RemoveStaleFiles(SystemFiles(), folder);
  const Contents contents = ReadContents(folder);
  const DatasetCardFiles card{ReadmeOf(contents), CroissantOf(contents)};
  const std::string croissant = JsonText(card.croissant, 2) + "\n";
  const bool has_sums = fs::exists(folder / RecordSums::kFileName);
  RecordSums sums = has_sums ? RecordSums::Read(folder) : RecordSums();
  if (readme != OldReadme::kReplace) {
    std::set<std::string> cards = ShortCards(contents.dataset, contents.provenance);
    cards.insert(card.readme);
    if (readme == OldReadme::kRefuseOthers && !IsOurs(folder, kReadmeRecord, sums, cards))
      RefuseToReplace(folder / kReadmeRecord);
    if (!IsOurs(folder, kCroissantRecord, sums, {croissant}))
      RefuseToReplace(folder / kCroissantRecord);
  }
  if (readme != OldReadme::kKeep) CommitFile(folder / kReadmeRecord, card.readme);
  CommitFile(folder / kCroissantRecord, croissant);
  // a dataset of an earlier build has no list, and half a one would be worse
  if (!has_sums) return;
  sums.SetHash(kReadmeRecord, Sha256OfFile(folder / kReadmeRecord));
  sums.Set(kCroissantRecord, croissant);
  sums.Commit(SystemFiles(), folder);
}

}  // namespace doorforge
