// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/occlusion.h"

#include <gtest/gtest.h>

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

// A box of a unit of pixels each: handle in front of the leaf, both facing the camera.
DoorAsset FacingDoor() {
  DoorAsset door = MakePrimitiveDoor({});
  for (DoorLink& link : door.links) link.geometry.clear();
  door.links[kLeafLink].geometry.push_back(
      {"leaf", BoxMesh({-0.02, -0.4, 1.1}, {0, 0.4, 1.9}), {}, {}, PointLabel::kBody});
  door.links[kHandleLink].geometry.push_back(
      {"grip", BoxMesh({0.02, -0.1, 1.4}, {0.021, 0.1, 1.6}), {}, {}, PointLabel::kHandle});
  return door;
}

CameraModel FacingCamera() {
  CameraModel camera;
  camera.position_m = {2, 0, 1.5};
  camera.target_m = {0, 0, 1.5};
  camera.width = camera.height = 1024;
  return camera;
}

// the ideal image of the door with a board of the robot over part of it
DepthImage SeenBehind(const DoorAsset& door, const TriangleMesh& board) {
  std::vector<VisibleMesh> meshes;
  for (const DoorLinkIndex link : {kLeafLink, kHandleLink}) {
    const DoorGeometry& geometry = door.links[link].geometry.front();
    meshes.push_back({geometry.mesh, link, geometry.label});
  }
  meshes.push_back({board, 3, PointLabel::kRobot});
  const std::vector<RigidTransform> poses(4, RigidTransform::Identity());
  return DepthCamera(meshes).Render(FacingCamera(), poses);
}

SceneSnapshot Still() {
  SceneSnapshot snapshot;
  snapshot.door.fill(RigidTransform::Identity());
  return snapshot;
}

TEST(Occlusion, OfBoxesIsTheRatioOfTheirAreas) {
  const DoorAsset door = FacingDoor();
  // hides the half of the handle that is at y < 0, and what of the leaf is beside that half
  const TriangleMesh board = BoxMesh({0.03, -0.4, 1.4}, {0.031, 0, 1.6});
  const Occlusion hidden =
      OcclusionMeter(door).Measure(SeenBehind(door, board), FacingCamera(), Still());
  EXPECT_NEAR(hidden.handle.by_robot, 0.5, 0.02);
  EXPECT_NEAR(hidden.handle.by_door, 0, 1e-9);
  EXPECT_NEAR(hidden.leaf.by_door, 0.2 * 0.2 / (0.8 * 0.8), 0.01);
  EXPECT_NEAR(hidden.leaf.by_robot, 0.3 * 0.2 / (0.8 * 0.8), 0.01);
}

TEST(Occlusion, WhatIsOutOfThePictureIsNotHidden) {
  const DoorAsset door = FacingDoor();
  CameraModel away = FacingCamera();
  away.target_m = {4, 0, 1.5};
  const std::vector<RigidTransform> poses(3, RigidTransform::Identity());
  const DepthImage empty = DepthCamera({}).Render(away, poses);
  const Occlusion hidden = OcclusionMeter(door).Measure(empty, away, Still());
  EXPECT_EQ(hidden.handle.by_robot, 0);
  EXPECT_EQ(hidden.leaf.by_door, 0);
}

}  // namespace
}  // namespace doorforge
