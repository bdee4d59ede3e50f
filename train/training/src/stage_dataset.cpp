// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/stage_dataset.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/networks/cloud_geometry.h"
#include "doorforge/networks/hand_frame.h"
#include "doorforge/networks/stage_networks.h"
#include "doorforge/policy/door_height.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/stage_content.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kCloudFloats = std::size_t{3} * kCloudPoints;

template <std::size_t N>
std::array<float, N> RowOf(std::span<const float> values, std::size_t row) {
  std::array<float, N> out{};
  std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row * N), N, out.begin());
  return out;
}

std::array<float, 3> ToArray(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

// Straight into the closed leaf, against the outward x of the door's frame.
std::array<float, 3> ApproachOf(const DatasetReader& reader, std::size_t episode) {
  const std::string path = "episode " + reader.entry(episode).key + ": meta.json";
  const Scene scene = EpisodeFromMeta(reader.Meta(episode), path).scene;
  return ToArray(-scene.world_from_door.linear().col(0).cast<float>());
}

MotionWay WayIn(const nlohmann::ordered_json& meta, const std::string& path) {
  const auto word = ValueOf<std::string>(meta, "way", path);
  const std::optional<MotionWay> way = ValueNamed<MotionWay>(word);
  if (!way) throw Error(ErrorCode::kFormat, path + ".way: unknown word \"" + word + '"');
  return *way;
}

// What an episode's clouds are made of, and which way its motion takes; data sets of earlier builds
// say nothing of it.
void AddWhatTheRecordSays(const nlohmann::ordered_json& meta, const std::string& path,
                          std::span<TrainingSample> samples) {
  for (TrainingSample& sample : samples) {
    if (meta.contains("cloud_within_m"))
      sample.cloud_crop_radius_m =
          static_cast<float>(ValueOf<double>(meta, "cloud_within_m", path));
    if (meta.contains("remembered_finer"))
      sample.remembered_finer = ValueOf<int>(meta, "remembered_finer", path);
    if (meta.contains("way")) sample.way = WayIn(meta, path);
  }
}

void RequireFinite(std::span<const float> values, const char* name, const std::string& key) {
  if (!std::ranges::all_of(values, [](float value) { return std::isfinite(value); }))
    throw Error(ErrorCode::kFormat, "episode " + key + ": " + name +
                                        " holds a number that is not finite; collect this data "
                                        "set again");
}

void RequireFinite(const EpisodeArrays& arrays, const std::string& key) {
  RequireFinite(arrays.cloud, "cloud", key);
  RequireFinite(arrays.proprio, "proprio", key);
  RequireFinite(arrays.action, "action", key);
  RequireFinite(arrays.executed, "executed", key);
  RequireFinite(arrays.score, "score", key);
}

void AppendEpisode(const EpisodeArrays& arrays, std::vector<TrainingSample>& samples) {
  for (std::size_t t = 0; t < arrays.decisions; ++t) {
    TrainingSample sample;
    sample.cloud = arrays.cloud.subspan(t * kCloudFloats, kCloudFloats);
    sample.label = arrays.label.subspan(t * kCloudPoints, kCloudPoints);
    sample.proprioception = RowOf<std::tuple_size_v<Proprioception>>(arrays.proprio, t);
    sample.action = RowOf<std::tuple_size_v<ActionVector>>(arrays.action, t);
    sample.executed = arrays.executed.empty()
                          ? sample.action
                          : RowOf<std::tuple_size_v<ActionVector>>(arrays.executed, t);
    sample.angle_gain_rad = arrays.score[t];
    samples.push_back(sample);
  }
}

// Whether the episode went on after its last decision: the stage "handle" had succeeded.
bool WentOn(const Episode& episode) {
  const PhysicsConfig& physics = episode.scene.physics;
  const double action_s = physics.steps_per_action * physics.time_step_s;
  return episode.outcome == EpisodeOutcome::kOpened ||
         episode.simulated_s > episode.decisions.back().time_s + 1.5 * action_s;
}

HingeSide SideIn(const nlohmann::ordered_json& meta, const std::string& path) {
  if (!meta.contains("side")) return HingeSide::kLeft;
  const auto word = ValueOf<std::string>(meta, "side", path);
  const std::optional<HingeSide> side = HingeSideNamed(word);
  if (!side) throw Error(ErrorCode::kFormat, path + ".side: unknown word \"" + word + '"');
  return *side;
}

// What MirroringPolicy shows of an episode's scene.
struct ShownMirrors {
  bool sideways = false;
  bool upside_down = false;
};

ShownMirrors MirrorsOf(const nlohmann::ordered_json& meta, const std::string& path,
                       std::string_view stage, const SampleOptions& options) {
  if (!options.shows_mirrored || FamilyOf(stage) == NetworkFamily::kGrasp) return {};
  const bool turns = stage == NameOf(Stage::kHandle) && meta.contains("way");
  return {SideIn(meta, path) == HingeSide::kRight, turns && WayIn(meta, path) == MotionWay::kOther};
}

// Episodes [begin, end) of a stage's split.
struct EpisodeRange {
  const DatasetReader& reader;
  const std::string& stage;
  std::size_t begin;
  std::size_t end;
};

// When the handle was "handle done": its angle before the next decision, against the scene's; after
// the last one, whether the episode went on to the opening. What an action was worth does not say
// it: that is a reward, and may become another one.
std::vector<TurnedExample> TurnedExamplesOf(const EpisodeRange& range,
                                            const SampleOptions& options) {
  constexpr double kRounding = 1e-6;  // [rad] of the shards' single precision
  const DatasetReader& reader = range.reader;
  std::vector<TurnedExample> examples;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const EpisodeArrays arrays = reader.Arrays(i);
    const std::string path = "episode " + reader.entry(i).key + ": meta.json";
    const nlohmann::ordered_json meta = reader.Meta(i);
    const Episode episode = EpisodeFromMeta(meta, path);
    Require(episode.decisions.size() == arrays.decisions, ErrorCode::kFormat,
            path + ".decision_time_s: found " + std::to_string(episode.decisions.size()) +
                " times, expected those of " + std::to_string(arrays.decisions) + " decisions");
    const double done = episode.scene.latch.handle_done_angle_rad - kRounding;
    const auto executed = arrays.executed.empty() ? arrays.action : arrays.executed;
    const ShownMirrors mirrors = MirrorsOf(meta, path, range.stage, options);
    const auto proprioception = [&](std::size_t t) {
      return RowOf<std::tuple_size_v<Proprioception>>(arrays.proprio, t);
    };
    for (std::size_t t = 0; t < arrays.decisions; ++t) {
      const auto action = RowOf<std::tuple_size_v<ActionVector>>(executed, t);
      const std::size_t next = t + 1;
      const bool turned = next < arrays.decisions
                              ? static_cast<double>(arrays.joints[2 * next + 1]) >= done
                              : WentOn(episode);
      HandMotion motion = HandMotionOf(proprioception(0), proprioception(t), action);
      if (mirrors.sideways) motion = MirroredSideways(motion);
      if (mirrors.upside_down) motion = MirroredUpright(motion);
      examples.push_back({motion, turned});
    }
  }
  return examples;
}

// The closed doors of the first `episodes`, as the camera sees them at the first decision.
void AppendClosedDoors(const DatasetReader& reader, std::size_t episodes, StageDataset& dataset) {
  for (std::size_t i = 0; i < episodes; ++i) {
    const EpisodeArrays arrays = reader.Arrays(i);
    const std::string path = "episode " + reader.entry(i).key + ": meta.json";
    std::vector<float> door;
    for (std::size_t point = 0; point < kCloudPoints; ++point) {
      if (arrays.label[point] == static_cast<std::uint8_t>(PointLabel::kRobot)) continue;
      const auto xyz = arrays.cloud.subspan(3 * point, 3);
      door.insert(door.end(), xyz.begin(), xyz.end());
    }
    if (door.empty()) continue;
    const auto first = RowOf<std::tuple_size_v<Proprioception>>(arrays.proprio, 0);
    dataset.sides.push_back(
        {SideNumbersOf(door, HandPositionOf(first)), SideIn(reader.Meta(i), path)});
    dataset.heights_m.push_back(HeightInView(door));
  }
}

void AddColors(const DatasetReader& reader, std::size_t episode,
               std::span<TrainingSample> samples) {
  const std::span<const std::uint8_t> rgb = reader.CloudColors(episode);
  Require(!rgb.empty(), ErrorCode::kInvalidArgument,
          "episode " + reader.entry(episode).key +
              ": its clouds have no colours; train with colors=false, or add them by `doorforge "
              "dataset re-observe ... --set pictures.cloud_rgb=true`");
  for (std::size_t t = 0; t < samples.size(); ++t)
    samples[t].rgb = rgb.subspan(t * kCloudFloats, kCloudFloats);
}

std::vector<TrainingSample> SamplesOf(const EpisodeRange& range, const SampleOptions& options) {
  const DatasetReader& reader = range.reader;
  const bool is_grasp = range.stage == NameOf(Stage::kGrasp);
  std::vector<TrainingSample> samples;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const EpisodeArrays arrays = reader.Arrays(i);
    if (arrays.points != kCloudPoints)
      throw Error(ErrorCode::kFormat, "episode " + reader.entry(i).key + ": clouds of " +
                                          std::to_string(arrays.points) +
                                          " points; the networks read " +
                                          std::to_string(kCloudPoints));
    RequireFinite(arrays, reader.entry(i).key);
    AppendEpisode(arrays, samples);
    const auto added = std::span(samples).last(arrays.decisions);
    const std::string path = "episode " + reader.entry(i).key + ": meta.json";
    const nlohmann::ordered_json meta = reader.Meta(i);
    AddWhatTheRecordSays(meta, path, added);
    if (options.colors) AddColors(reader, i, added);
    if (is_grasp) samples.back().approach = ApproachOf(reader, i);
    const ShownMirrors mirrors = MirrorsOf(meta, path, range.stage, options);
    if (mirrors.sideways) std::ranges::transform(added, added.begin(), internal::InMirror);
    if (mirrors.upside_down) std::ranges::transform(added, added.begin(), internal::UpsideDown);
  }
  return samples;
}

template <class T>
void AppendAll(std::vector<T> from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

void AppendEpisodes(const EpisodeRange& range, const SampleOptions& options,
                    std::vector<TrainingSample>& samples, std::vector<TurnedExample>& turned) {
  AppendAll(SamplesOf(range, options), samples);
  if (range.stage == NameOf(Stage::kHandle)) AppendAll(TurnedExamplesOf(range, options), turned);
}

// Appends a data set's samples.
void AppendDataset(const fs::path& folder, const std::string& stage, double validation_share,
                   StageDataset& dataset) {
  dataset.readers.push_back(std::make_unique<DatasetReader>(folder, stage, "train"));
  const DatasetReader& train = *dataset.readers.back();
  const std::size_t episodes = train.size();
  const bool opens = stage == NameOf(Stage::kOpen);
  if (fs::exists(folder / stage / "val")) {
    dataset.readers.push_back(std::make_unique<DatasetReader>(folder, stage, "val"));
    const DatasetReader& validation = *dataset.readers.back();
    AppendEpisodes({train, stage, 0, episodes}, dataset.options, dataset.train,
                   dataset.turned_train);
    if (opens) AppendClosedDoors(train, episodes, dataset);
    AppendEpisodes({validation, stage, 0, validation.size()}, dataset.options, dataset.validation,
                   dataset.turned_validation);
    return;
  }
  const auto aside = std::min(
      episodes > 0 ? episodes - 1 : 0,
      static_cast<std::size_t>(std::ceil(validation_share * static_cast<double>(episodes))));
  AppendEpisodes({train, stage, 0, episodes - aside}, dataset.options, dataset.train,
                 dataset.turned_train);
  if (opens) AppendClosedDoors(train, episodes - aside, dataset);
  AppendEpisodes({train, stage, episodes - aside, episodes}, dataset.options, dataset.validation,
                 dataset.turned_validation);
}

}  // namespace

StageDataset::StageDataset() = default;
StageDataset::~StageDataset() = default;
StageDataset::StageDataset(StageDataset&&) noexcept = default;
StageDataset& StageDataset::operator=(StageDataset&&) noexcept = default;

void StageDataset::RequireWhole() const {
  for (const auto& reader : readers) reader->RequireWhole();
}

StageDataset ReadStageDataset(std::span<const fs::path> folders, std::string_view stage,
                              double validation_share, const SampleOptions& options) {
  Require(!folders.empty(), ErrorCode::kInvalidArgument, "no data set to read samples from");
  StageDataset dataset;
  dataset.options = options;
  for (const fs::path& folder : folders) {
    dataset.parts = Union(dataset.parts, SeenPartsOfDataset(folder));
    AppendDataset(folder, StageReadOf(folder, stage), validation_share, dataset);
  }
  dataset.content_sha256 = StageContentSha256(folders, stage);
  dataset.RequireWhole();
  return dataset;
}

}  // namespace doorforge
