// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/film.h"

#include <cstdio>

#include "doorforge/sensor/scene_picture.h"

namespace doorforge {
namespace {

// From beside the robot, on the side of the hinge: the leaf turns its front there.
CameraModel SideView(const Scene& scene, const DoorAsset& door) {
  const Eigen::Vector3d grasp = scene.world_from_door * DoorFromLinks(door, 0, 0)[kHandleLink] *
                                door.handle_from_grasp.translation();
  CameraModel view;
  view.width = 480;
  view.height = 400;
  view.horizontal_fov_rad = 0.9;
  view.target_m = grasp + Eigen::Vector3d(0.25, -0.1, -0.1);
  view.position_m = view.target_m + Eigen::Vector3d(1.0, -1.6, 0.75);
  return view;
}

}  // namespace

Film::Film(const Scene& scene, const DoorAsset& door, const RobotModel& robot)
    : model_(scene.camera),
      view_(SideView(scene, door)),
      camera_(scene, door, robot),
      scene_(VisibleMeshesOf(door, robot)) {}

LabelledCloud Film::Observe(const SceneSnapshot& snapshot) {
  LabelledCloud cloud = camera_.Observe(snapshot);
  if (first_cloud_.label.empty()) first_cloud_ = cloud;
  return cloud;
}

void Film::Watch(const SceneSnapshot& snapshot) {
  // every second decision is enough to follow the motion
  if (snapshot.phase == EpisodePhase::kOpen && decisions_++ % 2 != 0) return;
  const std::vector<RigidTransform> poses = LinkPosesOf(snapshot);
  scene_.MoveLinks(poses);
  pictures_.push_back(RenderPicture(scene_, view_));
  char caption[64];
  std::snprintf(caption, sizeof caption, "%s %.2f s", std::string(NameOf(snapshot.phase)).c_str(),
                snapshot.time_s);
  captions_.emplace_back(caption);
}

void Film::Write(const std::filesystem::path& path) const {
  std::vector<Picture> pictures = pictures_;
  std::vector<std::string> captions = captions_;
  if (!first_cloud_.label.empty()) {
    pictures.push_back(CloudPicture(first_cloud_, model_));
    captions.emplace_back("cloud of the first decision");
  }
  WritePng(path, ContactSheet(pictures, captions, {4, 480, 400}));
}

}  // namespace doorforge
