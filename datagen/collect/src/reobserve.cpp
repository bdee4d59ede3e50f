// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/reobserve.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/free_space.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/rollout/proprioception.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/door_set.h"
#include "doorforge/schemas/episode_arrays.h"
#include "doorforge/schemas/shard.h"

#include "episode_records.h"
#include "recorded_robot.h"
#include "recording_camera.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Where an episode of the plan lies in the existing dataset.
struct Source {
  std::size_t shard = 0;
  std::optional<std::size_t> episode;    // written
  std::optional<FailedEpisode> failure;  // or not
};

// The numbers of one decision, from the arrays.
template <class T, std::size_t N>
std::array<T, N> RowOf(std::span<const T> values, std::size_t row) {
  std::array<T, N> out{};
  std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row * N), N, out.begin());
  return out;
}

Decision DecisionOf(const EpisodeArrays& arrays, std::size_t t, double time_s) {
  Decision decision;
  decision.proprioception = RowOf<float, std::tuple_size_v<Proprioception>>(arrays.proprio, t);
  decision.action = RowOf<float, std::tuple_size_v<ActionVector>>(arrays.action, t);
  decision.executed = arrays.executed.empty()
                          ? decision.action
                          : RowOf<float, std::tuple_size_v<ActionVector>>(arrays.executed, t);
  decision.state = RowOf<double, std::tuple_size_v<JointState>>(arrays.state, t);
  decision.time_s = time_s;
  decision.hinge_rad = static_cast<double>(arrays.joints[2 * t]);
  decision.handle_rad = static_cast<double>(arrays.joints[2 * t + 1]);
  decision.angle_gain_rad = static_cast<double>(arrays.score[t]);
  return decision;
}

SceneSnapshot SnapshotOf(const Decision& decision, const Scene& scene, const DoorAsset& door,
                         const RobotModel& robot) {
  const ProprioceptionPlaces places = ProprioceptionPlacesOf(robot);
  JointVector position(robot.joint_count());
  for (std::size_t place = 0; place < places.size(); ++place)
    if (places.at(place) >= 0) position[places.at(place)] = decision.state.at(place);
  SceneSnapshot snapshot;
  snapshot.robot = robot.PoseAt(position, scene.world_from_robot_base);
  snapshot.door = DoorFromLinks(door, decision.state[kStateHinge], decision.state[kStateHandle]);
  for (RigidTransform& pose : snapshot.door) pose = scene.world_from_door * pose;
  snapshot.time_s = decision.time_s;
  return snapshot;
}

// "ep000123" is episode 123 of the plan.
std::uint64_t NumberOf(const std::string& key, const std::string& where) {
  constexpr std::string_view kPrefix = "ep";
  std::uint64_t number = 0;
  const char* const end = key.data() + key.size();
  const char* const digits = key.data() + std::min(kPrefix.size(), key.size());
  const auto [after, error] = std::from_chars(digits, end, number);
  if (!key.starts_with(kPrefix) || error != std::errc{} || after != end)
    throw Error(ErrorCode::kFormat, where + ": the key \"" + key +
                                        "\" is none of an episode of a plan (ep000123); was the "
                                        "shard made by another program?");
  return number;
}

// The plan that the shards were made by, failed episodes included.
class SourceDataset {
 public:
  explicit SourceDataset(const fs::path& folder) : folder_(folder) {
    const fs::path path = folder / "provenance.json";
    ReadDataset(folder);  // refuses an unfinished one
    provenance_ = ProvenanceFromJson(ReadJsonFile(path), path.string());
    Require(!provenance_.planned.empty(), ErrorCode::kInvalidArgument,
            path.string() + ": names no plan; datasets of earlier builds hold no joint states");
    for (std::size_t i = 0; i < provenance_.doors.size(); ++i) {
      doors_[provenance_.doors[i].id] = i;
      plan_.sides.push_back(provenance_.doors[i].split == "train" ? DoorSide::kTrain
                                                                  : DoorSide::kVal);
    }
    for (const PlannedPart& part : provenance_.planned) AddPart(part.split);
  }

  const std::string& stage() const { return provenance_.planned.front().stage; }
  const DatasetProvenance& provenance() const { return provenance_; }
  const CollectionPlan& plan() const { return plan_; }
  const std::vector<ShardReader>& shards() const { return shards_; }
  /// The episode is one of plan().
  const Source& SourceOf(const std::string& key) const { return sources_.find(key)->second; }

  std::uint64_t decisions() const {
    std::uint64_t sum = 0;
    for (const ShardReader& shard : shards_) {
      for (const ShardEpisode& episode : shard.index().episodes) sum += episode.decisions;
    }
    return sum;
  }

  /// Identity of what is looked at again.
  std::string ContentHash() const {
    Sha256 hash;
    for (const ShardReader& shard : shards_) hash.Update(shard.index().tar_sha256);
    return hash.HexDigest();
  }

 private:
  void AddPart(const std::string& split) {
    if (!fs::is_directory(folder_ / stage() / split)) return;
    for (const fs::path& path : ShardIndices(folder_, stage(), split)) {
      shards_.emplace_back(path);
      AddShard(split);
    }
  }

  void AddShard(const std::string& split) {
    const std::size_t shard = shards_.size() - 1;
    const ShardIndex& index = shards_.back().index();
    PlannedShard planned{split, index.header.number, {}};
    for (std::size_t i = 0; i < index.episodes.size(); ++i) {
      const Json meta = ReadEpisodeMeta(shards_.back(), i);
      const std::string where = shards_.back().Describe(i, "meta.json");
      const auto door = ValueOf<std::string>(MemberOf(meta, "scene", where), "door_id", where);
      AddEpisode(index.episodes[i].key, door, {shard, i, {}}, planned);
    }
    for (const FailedEpisode& failure : index.failures)
      AddEpisode(failure.key, failure.door_id, {shard, {}, failure}, planned);
    std::sort(planned.episodes.begin(), planned.episodes.end(),
              [](const auto& a, const auto& b) { return a.number < b.number; });
    plan_.shards.push_back(std::move(planned));
  }

  void AddEpisode(const std::string& key, const std::string& door_id, Source source,
                  PlannedShard& planned) {
    const std::string where =
        (folder_ / stage() / planned.split / ShardStem(planned.number)).string() + ".tar";
    const auto door = doors_.find(door_id);
    if (door == doors_.end())
      throw Error(ErrorCode::kFormat, where + ": episode " + key + " is of door \"" + door_id +
                                          "\", which provenance.json does not name; verify the "
                                          "dataset");
    planned.episodes.push_back({NumberOf(key, where), door->second, key});
    if (!sources_.emplace(key, std::move(source)).second)
      throw Error(ErrorCode::kFormat,
                  where + ": episode " + key + " is in another shard as well; verify the dataset");
  }

  fs::path folder_;
  DatasetProvenance provenance_;
  CollectionPlan plan_;
  std::map<std::string, std::size_t> doors_;
  std::vector<ShardReader> shards_;
  std::map<std::string, Source> sources_;
};

// A failed episode stays one.
CollectedEpisode FailedAgain(const FailedEpisode& failure) {
  CollectedEpisode collected;
  const auto outcome = EpisodeOutcomeNamed(failure.outcome);
  if (!outcome) throw Error(ErrorCode::kInvalidArgument, failure.detail);
  collected.episode.outcome = *outcome;
  collected.episode.detail = failure.detail;
  collected.episode.peak_hinge_rad = failure.peak_hinge_rad;
  collected.episode.peak_handle_rad = failure.peak_handle_rad;
  return collected;
}

// The robot of all episodes.
struct RobotFile {
  std::string urdf;  // empty: the embedded one
  RobotMeshReader read_mesh;
};

class Reobservation {
 public:
  Reobservation(const SourceDataset& source, const ReobserveConfig& config, RobotFile robot,
                const std::vector<FoundDoor>& doors)
      : source_(source), config_(config), robot_file_(std::move(robot)), shelf_(doors) {}

  CollectedEpisode Observe(const PlannedEpisode& planned) {
    const Source& source = source_.SourceOf(planned.key);
    if (!source.episode) return FailedAgain(*source.failure);
    const ShardReader& reader = source_.shards()[source.shard];
    const Json meta = ReadEpisodeMeta(reader, *source.episode);
    const std::string where = reader.Describe(*source.episode, "meta.json");
    CollectedEpisode collected;
    collected.episode = EpisodeFromMeta(meta, where);
    collected.meta = meta;
    collected.keep_failed = true;
    ReadPoses(meta, where, collected.episode.scene);
    if (config_.own_camera) collected.episode.scene.camera = CameraOf(config_.camera);
    LookAtDecisions(ViewEpisode(reader, *source.episode), *shelf_.Take(planned.door), where,
                    collected);
    reader.RequireWhole();
    return collected;
  }

 private:
  void LookAtDecisions(const EpisodeArrays& arrays, const DoorAsset& door, const std::string& where,
                       CollectedEpisode& collected) const {
    Require(!arrays.state.empty(), ErrorCode::kInvalidArgument,
            where + ": the episode holds no joint states (state.npy); collect it anew");
    Episode& episode = collected.episode;
    if (episode.decisions.size() != arrays.decisions)
      throw Error(ErrorCode::kFormat, where + ": " + std::to_string(episode.decisions.size()) +
                                          " decision times, the arrays hold " +
                                          std::to_string(arrays.decisions) +
                                          " decisions; verify the dataset");
    const RobotModel robot = RobotOf(episode.scene);
    const bool sees_robot = config_.robot && (!collected.meta.contains("robot_seen") ||
                                              ValueOf<bool>(collected.meta, "robot_seen", where));
    const bool at_grasp = source_.stage() == NameOf(Stage::kGrasp);
    const Scene seen = at_grasp ? SceneOf(config_.grasp_camera, episode.scene) : episode.scene;
    const CloudExtent extent{config_.cloud.point_count,
                             at_grasp ? config_.grasp_camera.crop_radius_m : 0};
    RecordingCamera camera(seen, door, robot, config_.cloud, sees_robot);
    std::optional<RememberedView> before;
    if (source_.stage() == NameOf(Stage::kHandle) && config_.remembered.IsOn())
      before.emplace(seen, door, robot, config_.cloud, config_.remembered);
    for (std::size_t t = 0; t < arrays.decisions; ++t) {
      Decision decision = DecisionOf(arrays, t, episode.decisions[t].time_s);
      const SceneSnapshot snapshot = SnapshotOf(decision, episode.scene, door, robot);
      const Eigen::Vector3d start =
          at_grasp ? Eigen::Vector3d(decision.action[0], decision.action[1], decision.action[2])
                   : snapshot.robot.world_from_tcp.translation();
      LabelledCloud visible = camera.ObserveAll(snapshot);
      const bool joins = before && !visible.label.empty();
      decision.cloud = joins ? before->With(std::move(visible), start)
                             : SampleCloud(visible, start, extent).cloud;
      episode.decisions[t] = std::move(decision);
    }
    if (at_grasp) collected.meta["cloud_within_m"] = extent.crop_radius_m;
    if (before) {
      collected.meta["remembered_finer"] = config_.remembered.resolution_scale;
      collected.meta["cloud_within_m"] = config_.remembered.crop_radius_m;
    } else if (!at_grasp) {
      collected.meta.erase("remembered_finer");
      collected.meta.erase("cloud_within_m");
    }
    Describe(camera, seen, collected);
    collected.meta.erase("pictures");
    Remembering remembering{config_.cloud, {}};
    if (before) remembering.view = config_.remembered;
    AddPictures({seen, door, robot, sees_robot && config_.cloud.robot, camera.as_calibrated()},
                config_.pictures, camera, remembering, collected);
  }

  void Describe(const RecordingCamera& camera, const Scene& seen,
                CollectedEpisode& collected) const {
    const std::size_t decisions = collected.episode.decisions.size();
    Json& meta = collected.meta;
    meta["scene"]["camera"] = CameraToJson(collected.episode.scene.camera);
    meta["camera"] = CameraRecord(seen.camera);
    meta["visible_points"] = camera.Visible(decisions);
    meta["hidden"] = camera.OcclusionRecord(decisions);
    if (!config_.robot) meta["robot_seen"] = false;
    if (config_.preview) collected.preview_png = camera.PreviewPng(decisions);
  }

  RobotModel RobotOf(const Scene& scene) const {
    RobotModel robot = LoadRobot(robot_file_.urdf, scene.physics.base, robot_file_.read_mesh);
    Require(robot.sha256() == scene.robot.sha256, ErrorCode::kInvalidArgument,
            "robot \"" + scene.robot.name + "\" is another one than in the dataset");
    return robot;
  }

  const SourceDataset& source_;
  const ReobserveConfig& config_;
  RobotFile robot_file_;
  DoorCache shelf_;
};

// The cloud's settings as they were, and the file of the robot, from the existing config.yaml.
struct SourceConfig {
  ReobserveConfig config;
  std::string robot_file;
};

SourceConfig ReadSourceConfig(const fs::path& folder, const std::string& robot) {
  const fs::path path = folder / "config.yaml";
  const Json json = ParseYaml(ReadFile(path), path.string());
  SourceConfig source;
  if (json.contains("cloud")) Assign(json["cloud"], source.config.cloud, path.string() + ".cloud");
  // a data set of an earlier build has none: its clouds were of the whole door as it was seen then
  source.config.grasp_camera = {.resolution_scale = 1, .crop_radius_m = 0};
  source.config.remembered = {.resolution_scale = 0};
  if (json.contains("remembered"))
    Assign(json["remembered"], source.config.remembered, path.string() + ".remembered");
  if (json.contains("grasp_look"))
    Assign(json["grasp_look"], source.config.grasp_camera, path.string() + ".grasp_look");
  if (json.contains("preview"))
    source.config.preview = ValueOf<bool>(json, "preview", path.string());
  if (json.contains("pictures"))
    Assign(json["pictures"], source.config.pictures, path.string() + ".pictures");
  if (json.contains("robot") && json["robot"].is_boolean())
    source.config.robot = json["robot"].get<bool>();
  if (json.contains("scene"))
    source.robot_file = ValueOf<std::string>(json["scene"], "robot", path.string() + ".scene");
  source.robot_file = RecordedRobot(folder, source.robot_file, robot);
  return source;
}

ReobserveConfig ConfigOf(const ReobserveRequest& request, const ReobserveConfig& as_it_was) {
  ReobserveConfig config = LoadConfig<ReobserveConfig>(request.config, request.settings, as_it_was);
  if (request.without_robot) config.robot = false;
  config.own_camera = config.own_camera || ToJson(config.camera) != ToJson(CameraConfig{});
  CheckDepthNoise(config.cloud.noise);
  CheckGraspCamera(config.grasp_camera);
  CheckRememberedView(config.remembered);
  CheckPictures(config.pictures);
  CheckPictures(config.pictures, config.cloud);
  if (config.own_camera) CameraOf(config.camera);
  return config;
}

// Clouds and pictures alone, which nothing can make smaller.
void RequireSpaceForClouds(const SourceDataset& source, const ReobserveConfig& config,
                           const fs::path& out) {
  constexpr double kBytesAPoint = 13;
  // the episodes' own cameras may be larger than this one, and are not read for it
  const double a_decision =
      config.cloud.point_count * kBytesAPoint +
      PictureBytes(config.pictures, CameraOf(config.camera), config.cloud.point_count);
  const double needed = static_cast<double>(source.decisions()) * a_decision;
  RequireSpace(out, needed - BytesBelow(out), "make room, or choose another --out");
}

}  // namespace

CollectSummary ReobserveDataset(const ReobserveRequest& request) {
  const FolderLock lock(request.out, "doorforge dataset re-observe", Writers::kTogether);
  const SourceDataset source(request.folder);
  const SourceConfig source_config = ReadSourceConfig(request.folder, request.robot);
  const ReobserveConfig config = ConfigOf(request, source_config.config);
  RequireSpaceForClouds(source, config, request.out);
  const std::vector<FoundDoor> doors = FindRecordedDoors(
      DoorSelectionOf(request.doors, "train"), source.provenance().doors, request.threads);
  Reobservation reobservation(source, config, {source_config.robot_file, request.robot_meshes},
                              doors);
  CollectRequest collect;
  collect.folder = request.out;
  collect.stage = source.stage();
  collect.threads = request.threads;
  collect.provenance = source.provenance();
  collect.provenance.code_version = CodeVersion();
  collect.provenance.compiler = __VERSION__;
  collect.provenance.libraries = {{"ray_caster", RayCasterVersion()},
                                  {"looked_at_again", source.ContentHash()}};
  collect.config_text = "# doorforge dataset re-observe, " + CodeVersion() +
                        "\n# of shards sha256 " + source.ContentHash() + ", config sha256 " +
                        source.provenance().config_sha256 + "\n# rays by " + RayCasterVersion() +
                        "\n" + JsonText(ToJson(config), 2) + "\n";
  SystemFiles().CreateFolder(request.out);
  return Collect(
      source.plan(), [&](const PlannedEpisode& planned) { return reobservation.Observe(planned); },
      collect);
}

}  // namespace doorforge
