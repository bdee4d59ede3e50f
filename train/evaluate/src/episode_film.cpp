// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "episode_film.h"

#include <array>

#include "doorforge/report/html_numbers.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/scene_picture.h"

namespace doorforge::internal {
namespace {

constexpr int kTileWidth = 300;
constexpr int kTileHeight = 340;

// from the hinge's side, where the opening leaf shows its front, high enough to see the gripper
CameraModel ViewOf(const Scene& scene, const DoorAsset& door) {
  const Eigen::Vector3d grasp = scene.world_from_door * DoorFromLinks(door, 0, 0)[kHandleLink] *
                                door.handle_from_grasp.translation();
  CameraModel view;
  view.width = kTileWidth;
  view.height = kTileHeight;
  view.horizontal_fov_rad = 0.78;
  view.target_m = grasp + Eigen::Vector3d(0.38, -0.1, -0.15);
  view.position_m = view.target_m + Eigen::Vector3d(1.25, -1.9, 0.95);
  return view;
}

}  // namespace

LabelledCloud EpisodeFilm::Observe(const SceneSnapshot& snapshot) {
  if (first_decision_.empty()) first_decision_.push_back(snapshot);
  return camera_ ? camera_->Observe(snapshot) : LabelledCloud{};
}

void EpisodeFilm::Watch(const SceneSnapshot& snapshot) { watched_.push_back(snapshot); }

std::vector<EpisodeFilm::Frame> EpisodeFilm::Frames() const {
  constexpr std::array<std::pair<EpisodePhase, std::string_view>, 3> kNamed = {
      {{EpisodePhase::kStart, "start"},
       {EpisodePhase::kGrasp, "grasped"},
       {EpisodePhase::kUnlock, "unlocked"}}};
  std::vector<Frame> frames;
  const auto add = [&](const SceneSnapshot& snapshot, std::string_view name) {
    frames.push_back({snapshot, std::string(name) + ", " + Fixed(snapshot.time_s, 1) + " s"});
  };
  for (const auto& [phase, name] : kNamed) {
    for (const SceneSnapshot& snapshot : watched_) {
      if (snapshot.phase == phase) {
        add(snapshot, name);
        break;
      }
    }
  }
  std::vector<const SceneSnapshot*> opening;
  for (const SceneSnapshot& snapshot : watched_) {
    if (snapshot.phase == EpisodePhase::kOpen) opening.push_back(&snapshot);
  }
  if (opening.size() > 1) add(*opening[opening.size() / 2], "opening");
  if (!watched_.empty() && watched_.back().time_s > 0) add(watched_.back(), "end");
  return frames;
}

std::vector<ReportPicture> RenderFrames(const std::vector<EpisodeFilm::Frame>& frames,
                                        const Scene& scene, const DoorAsset& door,
                                        const RobotModel& robot) {
  SceneGeometry geometry(VisibleMeshesOf(door, robot));
  std::vector<ReportPicture> pictures;
  for (const EpisodeFilm::Frame& frame : frames) {
    geometry.MoveLinks(LinkPosesOf(frame.snapshot));
    pictures.push_back({EncodePng(RenderPicture(geometry, ViewOf(scene, door))), frame.caption});
  }
  return pictures;
}

}  // namespace doorforge::internal
