// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/camera_observer.h"

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
    if (piece.joint < 0) continue;
    meshes.push_back(
        {piece.mesh, kDoorLinks + piece.joint, PointLabel::kRobot, piece.color_rgba.head<3>()});
  }
  return meshes;
}

std::vector<RigidTransform> LinkPosesOf(const SceneSnapshot& snapshot) {
  std::vector<RigidTransform> poses(snapshot.door.begin(), snapshot.door.end());
  poses.insert(poses.end(), snapshot.robot.world_from_body.begin(),
               snapshot.robot.world_from_body.end());
  return poses;
}

CameraObserver::CameraObserver(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                               const CloudConfig& config)
    : model_(scene.camera), config_(config), camera_(VisibleMeshesOf(door, robot)) {}

LabelledCloud CameraObserver::Observe(const SceneSnapshot& snapshot) {
  const std::vector<RigidTransform> poses = LinkPosesOf(snapshot);
  const DepthImage image = camera_.Render(model_, poses);
  return ObserveCloud(image, model_, snapshot.robot.world_from_tcp.translation(), config_).cloud;
}

}  // namespace doorforge
