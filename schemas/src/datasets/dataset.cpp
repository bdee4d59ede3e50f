// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/dataset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/record_id.h"
#include "doorforge/schemas/picture_streams.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::string_view kTrain = "train";

// A length of 0 stands for the number of points, which each data set chooses for itself.
Json FeatureToJson(const EpisodeFeature& feature) {
  Json shape = Json::array({"decisions"});
  for (const std::size_t length : feature.shape)
    shape.push_back(length == 0 ? Json("points") : Json(length));
  return {{"name", feature.name},      {"member", feature.name + ".npy"},
          {"dtype", feature.type},     {"shape", shape},
          {"unit", feature.unit},      {"frame", feature.frame},
          {"meaning", feature.meaning}};
}

Json FeaturesToJson(const std::vector<EpisodeFeature>& pictures) {
  Json features = Json::array();
  for (const EpisodeFeature& feature : EpisodeFeatures())
    features.push_back(FeatureToJson(feature));
  for (const EpisodeFeature& feature : pictures) features.push_back(FeatureToJson(feature));
  return features;
}

// Adds those that are not known yet; `known` stays sorted by name.
void AddFeatures(const std::vector<EpisodeFeature>& found, std::vector<EpisodeFeature>& known) {
  for (const EpisodeFeature& feature : found) {
    const auto place = std::ranges::lower_bound(known, feature.name, {}, &EpisodeFeature::name);
    if (place == known.end() || place->name != feature.name) known.insert(place, feature);
  }
}

Json PartToJson(const DatasetPart& part) {
  return {{"stage", part.stage},
          {"split", part.split},
          {"shards", part.shards},
          {"episodes", part.episodes},
          {"failed_episodes", part.failed_episodes},
          {"decisions", part.decisions},
          {"bytes", part.bytes}};
}

DatasetPart PartFromJson(const Json& json, const std::string& path) {
  DatasetPart part;
  part.stage = IdOf(json, "stage", path);
  part.split = IdOf(json, "split", path);
  part.shards = ValueOf<std::uint64_t>(json, "shards", path);
  part.episodes = ValueOf<std::uint64_t>(json, "episodes", path);
  part.failed_episodes = ValueOf<std::uint64_t>(json, "failed_episodes", path);
  part.decisions = ValueOf<std::uint64_t>(json, "decisions", path);
  part.bytes = ValueOf<std::uint64_t>(json, "bytes", path);
  return part;
}

std::vector<double> NumbersFromJson(const Json& json, const std::string& key,
                                    const std::string& path) {
  std::vector<double> numbers;
  for (const Json& number : MemberOf(json, key, path)) {
    if (!number.is_number()) throw Error(ErrorCode::kFormat, path + "." + key + ": wrong type");
    numbers.push_back(number.get<double>());
  }
  return numbers;
}

// Those of the features that are arrays of pictures.
std::vector<EpisodeFeature> PicturesFromJson(const Json& json, const std::string& path) {
  std::vector<EpisodeFeature> pictures;
  if (!json.contains("features")) return pictures;
  for (const Json& feature : json["features"]) {
    const std::string where = path + ".features";
    std::vector<std::size_t> shape;
    for (const Json& length : MemberOf(feature, "shape", where)) {
      if (length.is_number_unsigned()) shape.push_back(length.get<std::size_t>());
      if (length == "points") shape.push_back(0);
    }
    if (auto picture = PictureFeature(ValueOf<std::string>(feature, "name", where), shape))
      pictures.push_back(std::move(*picture));
  }
  return pictures;
}

// Sums of one feature, from which its statistics follow. Added to in shard order, so that the
// result is the same for any number of threads that made the shards. The width is known to the
// compiler, which then keeps all sums in registers: a data set's clouds are most of its bytes.
template <std::size_t Width>
class FeatureSums {
 public:
  FeatureSums() {
    minimum_.fill(std::numeric_limits<double>::infinity());
    maximum_.fill(-std::numeric_limits<double>::infinity());
  }

  void Add(std::span<const float> rows) {
    const std::size_t row_count = rows.size() / Width;
    const float* values = rows.data();  // the span's own checks would be a quarter of the time
    Row sum = sum_;
    Row square = square_;
    Row minimum = minimum_;
    Row maximum = maximum_;
    for (std::size_t row = 0; row < row_count; ++row) {
      for (std::size_t i = 0; i < Width; ++i) {
        const double value = values[Width * row + i];
        sum[i] += value;
        square[i] += value * value;
        minimum[i] = std::min(minimum[i], value);
        maximum[i] = std::max(maximum[i], value);
      }
    }
    sum_ = sum;
    square_ = square;
    minimum_ = minimum;
    maximum_ = maximum;
    count_ += static_cast<double>(row_count);
  }

  FeatureStatistics Finish() const {
    FeatureStatistics statistics;
    for (std::size_t i = 0; i < Width; ++i) {
      const double mean = sum_[i] / count_;
      statistics.mean.push_back(mean);
      statistics.standard_deviation.push_back(
          std::sqrt(std::max(0.0, square_[i] / count_ - mean * mean)));
      statistics.minimum.push_back(minimum_[i]);
      statistics.maximum.push_back(maximum_[i]);
    }
    return statistics;
  }

 private:
  using Row = std::array<double, Width>;
  Row sum_{};
  Row square_{};
  Row minimum_;
  Row maximum_;
  double count_ = 0;
};

// It is of one cloud; sums stay in registers, as in FeatureSums.
std::array<double, 3> MeanPoint(std::span<const float> xyz) {
  double x = 0;
  double y = 0;
  double z = 0;
  for (const float* point = xyz.data(); point != xyz.data() + xyz.size(); point += 3) {
    x += point[0];
    y += point[1];
    z += point[2];
  }
  const auto points = static_cast<double>(xyz.size() / 3);
  return {x / points, y / points, z / points};
}

// Largest distance of a point from the mean of its cloud; `xyz` is one cloud.
double RadiusOf(std::span<const float> xyz) {
  const auto [mean_x, mean_y, mean_z] = MeanPoint(xyz);
  double largest = 0;
  for (const float* point = xyz.data(); point != xyz.data() + xyz.size(); point += 3) {
    const double x = point[0] - mean_x;
    const double y = point[1] - mean_y;
    const double z = point[2] - mean_z;
    largest = std::max(largest, x * x + y * y + z * z);
  }
  return std::sqrt(largest);
}

// Only what a training takes its normalisation from is summed; times and hidden shares are not.
class StatisticsBuilder {
 public:
  void Add(const EpisodeArrays& arrays) {
    action_.Add(arrays.action);
    cloud_.Add(arrays.cloud);
    joints_.Add(arrays.joints);
    proprio_.Add(arrays.proprio);
    score_.Add(arrays.score);
    for (std::size_t i = 0; i < arrays.decisions; ++i)
      radius_ = std::max(radius_,
                         RadiusOf(arrays.cloud.subspan(3 * arrays.points * i, 3 * arrays.points)));
    any_ = true;
  }

  void StoreIn(DatasetRecord& record) const {
    if (!any_) return;
    record.statistics = {{"action", action_.Finish()},
                         {"cloud", cloud_.Finish()},
                         {"joints", joints_.Finish()},
                         {"proprio", proprio_.Finish()},
                         {"score", score_.Finish()}};
    record.cloud_radius_m = radius_;
  }

 private:
  FeatureSums<9> action_;
  FeatureSums<3> cloud_;
  FeatureSums<2> joints_;
  FeatureSums<32> proprio_;
  FeatureSums<1> score_;
  double radius_ = 0;
  bool any_ = false;
};

// Names of the folders directly below `folder`, hidden ones left out, in ascending order.
std::set<std::string> FoldersIn(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_directory() && !name.starts_with('.')) names.insert(name);
  }
  return names;
}

DatasetPart SummarizePart(const fs::path& folder, const std::string& stage,
                          const std::string& split, StatisticsBuilder& statistics,
                          std::vector<EpisodeFeature>& pictures) {
  DatasetPart part{stage, split, 0, 0, 0, 0, 0};
  for (const fs::path& path : ShardIndices(folder, stage, split)) {
    const ShardReader reader(path);
    ++part.shards;
    part.episodes += reader.index().episodes.size();
    part.failed_episodes += reader.index().failures.size();
    part.bytes += reader.index().tar_bytes;
    if (!reader.index().episodes.empty()) AddFeatures(PictureFeaturesOf(reader, 0), pictures);
    for (std::size_t i = 0; i < reader.index().episodes.size(); ++i) {
      part.decisions += reader.index().episodes[i].decisions;
      // held-out episodes must not tell a training anything, not even a mean
      if (split == kTrain) statistics.Add(ViewEpisode(reader, i));
    }
    reader.RequireWhole();  // what was cut meanwhile has been read as zeros
  }
  return part;
}

Json DoorToJson(const DatasetDoor& door) {
  return {{"id", door.id},
          {"sha256", door.sha256},
          {"category", door.category},
          {"mechanism", door.mechanism},
          {"body", IdentityToJson(door.body)},
          {"handle", IdentityToJson(door.handle)},
          {"license", door.license},
          {"split", door.split}};
}

DatasetDoor DoorFromJson(const Json& json, const std::string& path) {
  DatasetDoor door;
  door.id = IdOf(json, "id", path);
  door.sha256 = ValueOf<std::string>(json, "sha256", path);
  door.category = ValueOf<std::string>(json, "category", path);
  door.mechanism = ValueOf<std::string>(json, "mechanism", path);
  door.body = IdentityFromJson(MemberOf(json, "body", path), path + ".body");
  door.handle = IdentityFromJson(MemberOf(json, "handle", path), path + ".handle");
  door.license = ValueOf<std::string>(json, "license", path);
  door.split = IdOf(json, "split", path);
  return door;
}

}  // namespace

Json DatasetToJson(const DatasetRecord& record) {
  Json parts = Json::array();
  for (const DatasetPart& part : record.parts) parts.push_back(PartToJson(part));
  Json statistics = Json::object();
  for (const auto& [name, feature] : record.statistics)
    statistics[name] = {{"mean", feature.mean},
                        {"standard_deviation", feature.standard_deviation},
                        {"minimum", feature.minimum},
                        {"maximum", feature.maximum}};
  return {{"schema", "doorforge.dataset"},
          {"schema_version", kDatasetSchemaVersion},
          {"features", FeaturesToJson(record.pictures)},
          {"parts", parts},
          {"train_statistics", statistics},
          {"train_cloud_radius_m", record.cloud_radius_m}};
}

DatasetRecord DatasetFromJson(const Json& json, const std::string& path) {
  RequireSchema(json, "doorforge.dataset", kDatasetSchemaVersion, path);
  DatasetRecord record;
  for (const Json& part : MemberOf(json, "parts", path))
    record.parts.push_back(PartFromJson(part, path + ".parts"));
  for (const auto& [name, feature] : MemberOf(json, "train_statistics", path).items()) {
    const std::string where = path + ".train_statistics." + name;
    record.statistics[name] = {NumbersFromJson(feature, "mean", where),
                               NumbersFromJson(feature, "standard_deviation", where),
                               NumbersFromJson(feature, "minimum", where),
                               NumbersFromJson(feature, "maximum", where)};
  }
  record.cloud_radius_m = ValueOf<double>(json, "train_cloud_radius_m", path);
  record.pictures = PicturesFromJson(json, path);
  return record;
}

DatasetRecord ReadDataset(const fs::path& folder) {
  const fs::path path = folder / "dataset.json";
  if (!fs::is_regular_file(path))
    throw Error(ErrorCode::kMissing,
                folder.string() +
                    ": no dataset here, or an unfinished one (no dataset.json); "
                    "finish it with --resume");
  return DatasetFromJson(ReadJsonFile(path), path.string());
}

namespace {

Json PlannedToJson(const PlannedPart& part) {
  return {{"stage", part.stage},
          {"split", part.split},
          {"shards", part.shards},
          {"episodes", part.episodes},
          {"episodes_per_shard", part.episodes_per_shard}};
}

PlannedPart PlannedFromJson(const Json& json, const std::string& path) {
  PlannedPart part;
  part.stage = IdOf(json, "stage", path);
  part.split = IdOf(json, "split", path);
  part.shards = ValueOf<std::uint64_t>(json, "shards", path);
  part.episodes = ValueOf<std::uint64_t>(json, "episodes", path);
  part.episodes_per_shard = ValueOf<std::uint64_t>(json, "episodes_per_shard", path);
  // the shards of a part are full but the last, so the three numbers must agree
  if (part.shards > 1000000 || part.episodes_per_shard < 1 ||
      part.episodes > part.shards * part.episodes_per_shard ||
      (part.shards > 0 && part.episodes <= (part.shards - 1) * part.episodes_per_shard))
    throw Error(ErrorCode::kFormat, path + ": " + std::to_string(part.episodes) +
                                        " episodes do not make " + std::to_string(part.shards) +
                                        " shards");
  return part;
}

DatasetPolicy DatasetPolicyFromJson(const Json& json, const std::string& path) {
  return {ValueOf<std::string>(json, "stage", path),
          ValueOf<std::string>(json, "policy_sha256", path),
          ValueOf<std::string>(json, "weights_sha256", path),
          ValueOf<std::string>(json, "dataset_sha256", path),
          ValueOf<std::string>(json, "code_version", path)};
}

}  // namespace

Json DatasetPolicyToJson(const DatasetPolicy& policy) {
  return {{"stage", policy.stage},
          {"policy_sha256", policy.policy_sha256},
          {"weights_sha256", policy.weights_sha256},
          {"dataset_sha256", policy.dataset_sha256},
          {"code_version", policy.code_version}};
}

Json ProvenanceToJson(const DatasetProvenance& provenance) {
  Json libraries = Json::object();
  for (const auto& [name, version] : provenance.libraries) libraries[name] = version;
  Json doors = Json::array();
  for (const DatasetDoor& door : provenance.doors) doors.push_back(DoorToJson(door));
  Json planned = Json::array();
  for (const PlannedPart& part : provenance.planned) planned.push_back(PlannedToJson(part));
  Json json = {{"schema", "doorforge.provenance"},
               {"schema_version", kDatasetSchemaVersion},
               {"code_version", provenance.code_version},
               {"compiler", provenance.compiler},
               {"libraries", libraries},
               {"config_sha256", provenance.config_sha256},
               {"seed", provenance.seed},
               {"planned", planned}};
  // data sets by rules alone keep the bytes that they had before there were policies
  if (!provenance.policies.empty()) {
    json["policies"] = Json::array();
    for (const DatasetPolicy& policy : provenance.policies)
      json["policies"].push_back(DatasetPolicyToJson(policy));
  }
  json["doors"] = doors;
  return json;
}

DatasetProvenance ProvenanceFromJson(const Json& json, const std::string& path) {
  RequireSchema(json, "doorforge.provenance", kDatasetSchemaVersion, path);
  DatasetProvenance provenance;
  provenance.code_version = ValueOf<std::string>(json, "code_version", path);
  provenance.compiler = ValueOf<std::string>(json, "compiler", path);
  const Json& libraries = MemberOf(json, "libraries", path);
  for (const auto& [name, unused] : libraries.items())
    provenance.libraries[name] = ValueOf<std::string>(libraries, name, path + ".libraries");
  provenance.config_sha256 = ValueOf<std::string>(json, "config_sha256", path);
  provenance.seed = ValueOf<std::uint64_t>(json, "seed", path);
  for (const Json& door : MemberOf(json, "doors", path))
    provenance.doors.push_back(DoorFromJson(door, path + ".doors"));
  // records of the first builds have neither
  if (json.contains("planned")) {
    for (const Json& part : json["planned"])
      provenance.planned.push_back(PlannedFromJson(part, path + ".planned"));
  }
  if (json.contains("policies")) {
    for (const Json& policy : json["policies"])
      provenance.policies.push_back(DatasetPolicyFromJson(policy, path + ".policies"));
  }
  return provenance;
}

std::string FailureLine(const FailedEpisode& failure, const DatasetPart& part) {
  const Json json = {{"stage", part.stage},
                     {"split", part.split},
                     {"key", failure.key},
                     {"door_id", failure.door_id},
                     {"outcome", failure.outcome},
                     {"detail", failure.detail},
                     {"peak_hinge_rad", failure.peak_hinge_rad},
                     {"peak_handle_rad", failure.peak_handle_rad}};
  return JsonText(json);
}

std::string DatasetCard(const DatasetRecord& record, const DatasetProvenance& provenance) {
  std::set<std::string> licenses;
  for (const DatasetDoor& door : provenance.doors) licenses.insert(door.license);
  std::string license = licenses.size() == 1 ? *licenses.begin() : "other";
  std::transform(license.begin(), license.end(), license.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::string card = "---\nlicense: " + license +
                     "\ntags:\n- robotics\n- manipulation\n- articulated-objects\n- point-clouds\n"
                     "- webdataset\n---\n\n# Door episodes\n\n"
                     "A mobile Franka opens latched doors in simulation; every decision point "
                     "holds the cloud that a depth camera sees, what the robot feels of itself, "
                     "and what the expert asked for next. Made by doorforge " +
                     provenance.code_version + " with seed " + std::to_string(provenance.seed) +
                     ".\n\n| stage | split | episodes | failed | decisions | shards | MiB |\n"
                     "|---|---|---|---|---|---|---|\n";
  for (const DatasetPart& part : record.parts)
    card += "| " + part.stage + " | " + part.split + " | " + std::to_string(part.episodes) + " | " +
            std::to_string(part.failed_episodes) + " | " + std::to_string(part.decisions) + " | " +
            std::to_string(part.shards) + " | " + std::to_string(part.bytes >> 20) + " |\n";
  card += "\nDoors: " + std::to_string(provenance.doors.size()) +
          "; no body and no handle is on "
          "both sides of a split. Licences of the doors' parts:";
  for (const std::string& name : licenses) card += " " + name;
  return card +
         ".\n\nThe shards are plain tar files of .npy arrays with a JSON index beside each. "
         "`dataset.json` describes every array, `provenance.json` every door; "
         "`python/doorforge_reader.py` of doorforge reads them with numpy alone, and "
         "WebDataset and Hugging Face `datasets` read them directly.\n";
}

namespace {

// What a data set holds instead of what was looked for: "; it holds open/train, open/val".
std::string PartsIn(const fs::path& folder) {
  std::string parts;
  for (const char* stage : {"grasp", "handle", "open"}) {
    if (!fs::is_directory(folder / stage)) continue;
    for (const std::string& split : FoldersIn(folder / stage))
      parts += (parts.empty() ? "" : ", ") + std::string(stage) + "/" + split;
  }
  return parts.empty() ? "" : "; it holds " + parts;
}

}  // namespace

std::vector<fs::path> ShardIndices(const fs::path& folder, std::string_view stage,
                                   std::string_view split) {
  const fs::path part = folder / stage / split;
  if (!fs::is_directory(part))
    throw Error(ErrorCode::kMissing,
                part.string() + ": no such part of a dataset" + PartsIn(folder));
  std::set<fs::path> indices;
  for (const auto& entry : fs::directory_iterator(part)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("shard-") && name.ends_with(".index.json")) indices.insert(entry.path());
  }
  return {indices.begin(), indices.end()};
}

DatasetRecord SummarizeShards(const fs::path& folder) {
  DatasetRecord record;
  StatisticsBuilder statistics;
  for (const std::string& stage : FoldersIn(folder)) {
    if (stage != "open" && stage != "handle" && stage != "grasp") continue;
    for (const std::string& split : FoldersIn(folder / stage))
      record.parts.push_back(SummarizePart(folder, stage, split, statistics, record.pictures));
  }
  statistics.StoreIn(record);
  return record;
}

DatasetReader::DatasetReader(const fs::path& folder, std::string_view stage, std::string_view split,
                             CrcCheck check) {
  for (const fs::path& path : ShardIndices(folder, stage, split)) {
    shards_.emplace_back(path, check);
    const std::string& found = shards_.back().index().header.stage;
    if (found != stage)
      throw Error(ErrorCode::kFormat, path.string() + ": a shard of the stage \"" + found +
                                          "\" among those of \"" + std::string(stage) +
                                          "\"; was it moved here by hand?");
    for (std::size_t i = 0; i < shards_.back().index().episodes.size(); ++i)
      places_.push_back({shards_.size() - 1, i});
  }
}

const ShardEpisode& DatasetReader::entry(std::size_t episode) const {
  const Place& place = places_.at(episode);
  return shards_[place.shard].index().episodes[place.episode];
}

EpisodeArrays DatasetReader::Arrays(std::size_t episode) const {
  const Place& place = places_.at(episode);
  return ViewEpisode(shards_[place.shard], place.episode);
}

std::span<const std::uint8_t> DatasetReader::CloudColors(std::size_t episode) const {
  const Place& place = places_.at(episode);
  return ViewCloudColors(shards_[place.shard], place.episode);
}

Json DatasetReader::Meta(std::size_t episode) const {
  const Place& place = places_.at(episode);
  return ReadEpisodeMeta(shards_[place.shard], place.episode);
}

void DatasetReader::RequireWhole() const {
  for (const ShardReader& shard : shards_) shard.RequireWhole();
}

std::string DatasetReader::ContentHash() const {
  Sha256 hash;
  for (const ShardReader& shard : shards_) hash.Update(shard.index().tar_sha256);
  return hash.HexDigest();
}

}  // namespace doorforge
