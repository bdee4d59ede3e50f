// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/camera_observer.h"

#include <string>

namespace doorforge {
namespace {

constexpr int kDoorLinks = 3;

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
                               const CloudConfig& config)
    : seed_(scene.seed),
      stream_("sensor/" + scene.door_id + "/" + std::to_string(scene.episode) + "/"),
      model_(scene.camera),
      believed_(BelievedCamera(scene.camera, config.noise, Stream("calibration"))),
      config_(config),
      camera_(VisibleMeshesOf(door, robot)) {}

Rng CameraObserver::Stream(const std::string& purpose) const { return {seed_, stream_ + purpose}; }

Sight CameraObserver::Look(const SceneSnapshot& snapshot) {
  const std::vector<RigidTransform> poses = LinkPosesOf(snapshot);
  Sight sight;
  sight.ideal = camera_.Render(model_, poses);
  sight.depth =
      WithDepthNoise(sight.ideal, model_, config_.noise, Stream(std::to_string(looks_++)));
  sight.sampled =
      ObserveCloud(sight.depth, believed_, snapshot.robot.world_from_tcp.translation(), config_);
  return sight;
}

LabelledCloud CameraObserver::Observe(const SceneSnapshot& snapshot) {
  return Look(snapshot).sampled.cloud;
}

}  // namespace doorforge
