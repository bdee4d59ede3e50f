// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "open_stage.h"

#include <optional>
#include <utility>

#include "doorforge/core/config_io.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/sensor/picture.h"

namespace doorforge {
namespace {

// The policy's camera, which also keeps the first and the last depth image.
class RecordingCamera : public Observer {
 public:
  RecordingCamera(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                  const CloudConfig& config)
      : model_(scene.camera), config_(config), camera_(VisibleMeshesOf(door, robot)) {}

  LabelledCloud Observe(const SceneSnapshot& snapshot) override {
    const std::vector<RigidTransform> poses = LinkPosesOf(snapshot);
    last_ = camera_.Render(model_, poses);
    if (!first_) first_ = last_;
    SampledCloud sampled =
        ObserveCloud(*last_, model_, snapshot.robot.world_from_tcp.translation(), config_);
    visible_.push_back(sampled.visible_count);
    return std::move(sampled.cloud);
  }

  /// Points inside the crop before sampling, one number a decision.
  const std::vector<int>& visible() const { return visible_; }

  std::string PreviewPng() const {
    if (!first_) return {};
    const Picture pictures[] = {DepthPreview(*first_, config_.max_depth_m),
                                DepthPreview(*last_, config_.max_depth_m)};
    return EncodePng(ContactSheet(
        pictures, {}, {.columns = 2, .tile_width = model_.width, .tile_height = model_.height}));
  }

 private:
  CameraModel model_;
  CloudConfig config_;
  DepthCamera camera_;
  std::optional<DepthImage> first_;
  std::optional<DepthImage> last_;
  std::vector<int> visible_;
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
  const Scene scene = SampleScene(door, config.seed, planned.number, config.scene);
  OpeningExpert expert(config.expert);
  RecordingCamera camera(scene, door, robot, config.cloud);
  CollectedEpisode collected;
  collected.episode = RunEpisode(scene, door, robot, expert, &camera);
  collected.meta = EpisodeMetaToJson(collected.episode);
  collected.meta["door"] = DoorRecord(door);
  collected.meta["camera"] = CameraRecord(scene.camera);
  collected.meta["visible_points"] = camera.visible();
  collected.meta["policies"] = {{"grasp", "expert"}, {"unlock", "expert"}, {"open", "expert"}};
  if (config.preview && collected.episode.outcome == EpisodeOutcome::kOpened)
    collected.preview_png = camera.PreviewPng();
  return collected;
}

}  // namespace doorforge
