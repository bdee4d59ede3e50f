// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/camera_observer.h"

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/rollout/solid_around.h"

namespace doorforge {
namespace {

constexpr int kDoorLinks = 3;
constexpr int kWholeShare = 4;  // points of a whole cloud for each that is sampled of it

// From inside a leaf everything is hidden, and every cloud would be empty.
void RequireOutside(const CameraModel& camera, const Scene& scene, const DoorAsset& door) {
  const std::string_view solid = SolidAround(camera.position_m, scene, door);
  if (solid.empty()) return;
  char text[300];
  std::snprintf(text, sizeof text,
                "the camera at (%.3f, %.3f, %.3f) m is inside the %s of door \"%.120s\"; put "
                "scene.camera where it looks at the door from outside",
                camera.position_m.x(), camera.position_m.y(), camera.position_m.z(),
                std::string(solid).c_str(), door.id.c_str());
  throw Error(ErrorCode::kInvalidArgument, text);
}

std::vector<VisibleMesh> WithoutRobot(std::vector<VisibleMesh> meshes) {
  std::erase_if(meshes, [](const VisibleMesh& mesh) { return mesh.link >= kDoorLinks; });
  return meshes;
}

}  // namespace

std::vector<VisibleMesh> VisibleMeshesOf(const DoorAsset& door, const RobotModel& robot) {
  std::vector<VisibleMesh> meshes;
  for (int link = 0; link < kDoorLinks; ++link) {
    for (const DoorGeometry& geometry : door.links[static_cast<std::size_t>(link)].geometry)
      meshes.push_back({geometry.mesh, link, geometry.label, geometry.color_rgba.head<3>()});
  }
  for (const RobotPiece& piece : robot.visuals()) {
    const int body = piece.joint < 0 ? robot.joint_count() : piece.joint;
    meshes.push_back(
        {piece.mesh, kDoorLinks + body, PointLabel::kRobot, piece.color_rgba.head<3>()});
  }
  return meshes;
}

std::vector<RigidTransform> LinkPosesOf(const SceneSnapshot& snapshot) {
  std::vector<RigidTransform> poses(snapshot.door.begin(), snapshot.door.end());
  poses.insert(poses.end(), snapshot.robot.world_from_body.begin(),
               snapshot.robot.world_from_body.end());
  poses.push_back(snapshot.robot.world_from_base);
  return poses;
}

CameraObserver::CameraObserver(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                               const CloudConfig& config, bool sees_robot)
    : seed_(scene.seed),
      stream_("sensor/" + scene.door_id + "/" + std::to_string(scene.episode) + "/"),
      model_(scene.camera),
      camera_as_calibrated_(
          CameraWithCalibrationError(scene.camera, config.noise, Stream("calibration"))),
      config_(config),
      extent_{config.point_count},
      camera_(sees_robot && config.robot ? VisibleMeshesOf(door, robot)
                                         : WithoutRobot(VisibleMeshesOf(door, robot))) {
  RequireOutside(model_, scene, door);
  if (config_.whole)
    whole_.emplace(camera_.scene().meshes(), kWholeShare * config_.point_count, Stream("surface"));
}

Rng CameraObserver::Stream(const std::string& purpose) const { return {seed_, stream_ + purpose}; }

void CameraObserver::Remember(RememberedView before) { before_ = std::move(before); }

void CameraObserver::ColorWith(std::unique_ptr<ColorSource> colors) {
  Require(!whole_, ErrorCode::kInvalidArgument,
          "a whole cloud has no colours: no picture shows all of its points");
  colors_ = std::move(colors);
}

void CameraObserver::SampleAs(const CloudExtent& extent) {
  SampleCloud({}, Eigen::Vector3d::Zero(), extent);  // refuses what it cannot make
  extent_ = extent;
  before_.reset();
}

CameraFrame CameraObserver::Render(const SceneSnapshot& snapshot) {
  const std::vector<RigidTransform> poses = LinkPosesOf(snapshot);
  CameraFrame frame;
  frame.ideal = camera_.Render(model_, poses);
  const int look = looks_++;
  frame.depth = WithDepthNoise(frame.ideal, model_, config_.noise, Stream(std::to_string(look)));
  if (colors_) frame.depth.rgb = colors_->ColorsAt(snapshot, look);
  frame.visible = whole_ ? whole_->At(poses, config_.min_height_m)
                         : CropCloud(frame.depth, camera_as_calibrated_, config_);
  frame.sampled = SampleCloud(frame.visible, snapshot.robot.world_from_tcp.translation(), extent_);
  if (before_ && snapshot.phase == EpisodePhase::kUnlock && !frame.visible.label.empty())
    frame.sampled.cloud = before_->With(frame.visible, snapshot.robot.world_from_tcp.translation());
  if (colors_)
    frame.sampled.cloud.picture = std::make_shared<const CameraPicture>(
        CameraPicture{frame.depth.width, frame.depth.height, frame.depth.rgb, frame.depth.depth_m});
  return frame;
}

LabelledCloud CameraObserver::Observe(const SceneSnapshot& snapshot) {
  return Render(snapshot).sampled.cloud;
}

}  // namespace doorforge
