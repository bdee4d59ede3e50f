// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "recording_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "doorforge/sensor/picture.h"

namespace doorforge {
namespace {

constexpr int kWidestPreview = 256;  // of each of its pictures

}  // namespace

RecordingCamera::RecordingCamera(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                                 const CloudConfig& config, bool sees_robot)
    : model_(scene.camera),
      max_depth_m_(config.max_depth_m),
      camera_(scene, door, robot, config, sees_robot),
      occlusion_(door) {}

LabelledCloud RecordingCamera::Observe(const SceneSnapshot& snapshot) {
  return Render(snapshot).sampled.cloud;
}

LabelledCloud RecordingCamera::ObserveAll(const SceneSnapshot& snapshot) {
  return Render(snapshot).visible;
}

CameraFrame RecordingCamera::Render(const SceneSnapshot& snapshot) {
  CameraFrame frame = camera_.Render(snapshot);
  visible_.push_back(frame.sampled.visible_count);
  hidden_.push_back(occlusion_.Measure(frame.ideal, model_, snapshot));
  looks_.push_back({snapshot, frame.depth});
  return frame;
}

std::vector<int> RecordingCamera::Visible(std::size_t looks) const {
  const std::size_t count = std::min(looks, visible_.size());
  return {visible_.begin(), visible_.begin() + static_cast<std::ptrdiff_t>(count)};
}

nlohmann::ordered_json RecordingCamera::OcclusionRecord(std::size_t looks) const {
  nlohmann::ordered_json record;
  const auto add = [&](const char* key, auto&& share) {
    record[key] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < std::min(looks, hidden_.size()); ++i)
      record[key].push_back(std::round(share(hidden_[i]) * 1e4) / 1e4);
  };
  add("handle_by_robot", [](const Occlusion& o) { return o.handle.by_robot; });
  add("handle_by_door", [](const Occlusion& o) { return o.handle.by_door; });
  add("leaf_by_robot", [](const Occlusion& o) { return o.leaf.by_robot; });
  add("leaf_by_door", [](const Occlusion& o) { return o.leaf.by_door; });
  return record;
}

std::span<const PictureLook> RecordingCamera::Looks(std::size_t looks) const {
  return std::span(looks_).first(std::min(looks, looks_.size()));
}

std::string RecordingCamera::PreviewPng(std::size_t looks) const {
  const std::span<const PictureLook> seen = Looks(looks);
  if (seen.empty()) return {};
  const Picture pictures[] = {DepthPreview(seen.front().depth, max_depth_m_),
                              DepthPreview(seen.back().depth, max_depth_m_)};
  const int width = std::min(model_.width, kWidestPreview);
  const int height = model_.height * width / model_.width;
  return EncodePng(
      ContactSheet(pictures, {}, {.columns = 2, .tile_width = width, .tile_height = height}));
}

void AddPictures(const PictureScene& scene, const PicturesConfig& config,
                 const RecordingCamera& camera, const Remembering& remembering,
                 CollectedEpisode& collected) {
  if (!config.IsOn() || !IsData(collected)) return;
  const std::vector<Decision>& decisions = collected.episode.decisions;
  PicturedClouds clouds;
  std::optional<RememberedLook> before;
  if (config.cloud_rgb) {
    for (const Decision& decision : decisions) clouds.clouds.push_back(&decision.cloud);
    if (remembering.view)
      clouds.before = &before.emplace(
          LookBefore(scene.scene, scene.door, scene.robot, remembering.cloud, *remembering.view));
  }
  Pictures pictures = TakePictures(scene, config, camera.Looks(decisions.size()), clouds);
  collected.pictures = std::move(pictures.members);
  if (!pictures.record.empty()) collected.meta["pictures"] = std::move(pictures.record);
}

}  // namespace doorforge
