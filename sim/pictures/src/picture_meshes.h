// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/pictures/take_pictures.h"
#include "doorforge/rollout/camera_observer.h"

namespace doorforge {

/// What there is to be seen: the door, and the robot where it is there.
inline std::vector<VisibleMesh> PictureMeshesOf(const PictureScene& scene) {
  std::vector<VisibleMesh> meshes = VisibleMeshesOf(scene.door, scene.robot);
  if (!scene.sees_robot)
    std::erase_if(meshes, [](const VisibleMesh& mesh) { return mesh.label == PointLabel::kRobot; });
  return meshes;
}

}  // namespace doorforge
