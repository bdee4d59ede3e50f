// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "open_stage.h"

#include <cmath>
#include <optional>
#include <utility>

#include "doorforge/core/config_io.h"
#include "doorforge/rollout/occlusion.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/rollout/standing_place.h"
#include "doorforge/sensor/picture.h"

namespace doorforge {
namespace {

// The policy's camera, which also keeps the first and the last depth image and what was hidden.
class RecordingCamera : public Observer {
 public:
  RecordingCamera(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                  const CloudConfig& config)
      : model_(scene.camera),
        max_depth_m_(config.max_depth_m),
        camera_(scene, door, robot, config),
        occlusion_(door) {}

  LabelledCloud Observe(const SceneSnapshot& snapshot) override {
    Sight sight = camera_.Look(snapshot);
    visible_.push_back(sight.sampled.visible_count);
    hidden_.push_back(occlusion_.Measure(sight.ideal, model_, snapshot));
    last_ = std::move(sight.depth);
    if (!first_) first_ = last_;
    return std::move(sight.sampled.cloud);
  }

  /// Points inside the crop before sampling, one number a decision.
  const std::vector<int>& visible() const { return visible_; }

  /// Hidden shares, one number a decision each.
  nlohmann::ordered_json OcclusionRecord() const {
    nlohmann::ordered_json record;
    const auto add = [&](const char* key, auto&& share) {
      record[key] = nlohmann::ordered_json::array();
      for (const Occlusion& hidden : hidden_)
        record[key].push_back(std::round(share(hidden) * 1e4) / 1e4);
    };
    add("handle_by_robot", [](const Occlusion& o) { return o.handle.by_robot; });
    add("handle_by_door", [](const Occlusion& o) { return o.handle.by_door; });
    add("leaf_by_robot", [](const Occlusion& o) { return o.leaf.by_robot; });
    add("leaf_by_door", [](const Occlusion& o) { return o.leaf.by_door; });
    return record;
  }

  std::string PreviewPng() const {
    if (!first_) return {};
    const Picture pictures[] = {DepthPreview(*first_, max_depth_m_),
                                DepthPreview(*last_, max_depth_m_)};
    return EncodePng(ContactSheet(
        pictures, {}, {.columns = 2, .tile_width = model_.width, .tile_height = model_.height}));
  }

 private:
  CameraModel model_;
  double max_depth_m_;
  CameraObserver camera_;
  OcclusionMeter occlusion_;
  std::optional<DepthImage> first_;
  std::optional<DepthImage> last_;
  std::vector<int> visible_;
  std::vector<Occlusion> hidden_;
};

nlohmann::ordered_json CameraRecord(const CameraModel& camera) {
  nlohmann::ordered_json matrix = nlohmann::ordered_json::array();
  const Eigen::Matrix3d intrinsics = IntrinsicMatrix(camera);
  for (Eigen::Index row = 0; row < 3; ++row)
    matrix.push_back({intrinsics(row, 0), intrinsics(row, 1), intrinsics(row, 2)});
  return {{"intrinsic_matrix_px", matrix},
          {"world_from_camera", TransformToJson(WorldFromCamera(camera))}};
}

nlohmann::ordered_json DoorRecord(const DoorAsset& door) {
  return {{"id", door.id},
          {"category", NameOf(door.category)},
          {"mechanism", NameOf(door.mechanism)},
          {"body", IdentityToJson(door.body)},
          {"handle", IdentityToJson(door.handle)},
          {"license", door.license}};
}

}  // namespace

CollectedEpisode RunOpenEpisode(const PlannedEpisode& planned, const DoorAsset& door,
                                const RobotModel& robot, const OpenStageConfig& config) {
  const Scene scene =
      SceneFor(robot, SampleScene(door, config.seed, planned.number, config.scene), door);
  OpeningExpert expert(config.expert);
  RecordingCamera camera(scene, door, robot, config.cloud);
  CollectedEpisode collected;
  collected.episode = RunEpisode(scene, door, robot, expert, &camera);
  collected.meta = EpisodeMetaToJson(collected.episode);
  collected.meta["door"] = DoorRecord(door);
  collected.meta["camera"] = CameraRecord(scene.camera);
  collected.meta["visible_points"] = camera.visible();
  collected.meta["hidden"] = camera.OcclusionRecord();
  collected.meta["policies"] = {{"grasp", "expert"}, {"unlock", "expert"}, {"open", "expert"}};
  if (config.preview && collected.episode.outcome == EpisodeOutcome::kOpened)
    collected.preview_png = camera.PreviewPng();
  return collected;
}

}  // namespace doorforge
