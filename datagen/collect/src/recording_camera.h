// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/dataset/collect.h"
#include "doorforge/pictures/take_pictures.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/occlusion.h"
#include "doorforge/rollout/remembered_view.h"

namespace doorforge {

/// The policy's camera, which also keeps what an episode's record says of its looks: how many
/// points were visible, what was hidden, the depth images of the preview.
class RecordingCamera : public Observer {
 public:
  /// Takes what CameraObserver's constructor takes. Without `sees_robot` only the door is there.
  RecordingCamera(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                  const CloudConfig& config, bool sees_robot = true);

  /// Does what CameraObserver::Remember() does.
  void Remember(RememberedView before) { camera_.Remember(std::move(before)); }

  /// Does what CameraObserver::ColorWith() does.
  void ColorWith(std::unique_ptr<ColorSource> colors) { camera_.ColorWith(std::move(colors)); }

  LabelledCloud Observe(const SceneSnapshot& snapshot) override;
  /// Observes too, but keeps every point that is visible.
  LabelledCloud ObserveAll(const SceneSnapshot& snapshot);

  /// Points inside the crop before sampling, of the first `looks` looks.
  std::vector<int> Visible(std::size_t looks) const;
  /// Hidden shares by name, one number a look each, of the first `looks` looks.
  nlohmann::ordered_json OcclusionRecord(std::size_t looks) const;
  /// Depth at the first and at the last of the first `looks` looks; empty if there was none. Who
  /// acts after the recorded stage looks through this camera too.
  std::string PreviewPng(std::size_t looks) const;
  /// The first `looks` looks, for pictures; fewer if there were fewer.
  std::span<const PictureLook> Looks(std::size_t looks) const;
  const CameraModel& as_calibrated() const { return camera_.as_calibrated(); }

 private:
  CameraFrame Render(const SceneSnapshot& snapshot);

  CameraModel model_;
  double max_depth_m_;
  CameraObserver camera_;
  OcclusionMeter occlusion_;
  std::vector<PictureLook> looks_;
  std::vector<int> visible_;
  std::vector<Occlusion> hidden_;
};

/// Where the clouds of an episode are joined with what was seen before the robot came.
struct Remembering {
  const CloudConfig& cloud;
  std::optional<RememberedViewConfig> view;  ///< Nothing: they are not.
};

/// Adds the pictures of all decisions, as seen with the looks of this camera, unless the episode is
/// not written.
void AddPictures(const PictureScene& scene, const PicturesConfig& config,
                 const RecordingCamera& camera, const Remembering& remembering,
                 CollectedEpisode& collected);

}  // namespace doorforge
