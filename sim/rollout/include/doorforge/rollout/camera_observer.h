// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/rollout/observer.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/scene.h"
#include "doorforge/sensor/depth_camera.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// What the camera sees of a robot and a door. Links: the door's base, leaf and handle are 0 to 2,
/// the body of robot joint j is 3 + j; pieces fixed to the robot's base are left out.
std::vector<VisibleMesh> VisibleMeshesOf(const DoorAsset& door, const RobotModel& robot);

/// The links' poses at an instant, in the order of VisibleMeshesOf().
std::vector<RigidTransform> LinkPosesOf(const SceneSnapshot& snapshot);

/// The scene's camera: depth of robot and door, cropped and sampled to the policy's cloud. Point 0
/// is the visible point nearest to the tool centre. Serves one thread at a time.
class CameraObserver : public Observer {
 public:
  /// @throws Error(kInvalidArgument) as DepthCamera does.
  CameraObserver(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                 const CloudConfig& config = {});

  LabelledCloud Observe(const SceneSnapshot& snapshot) override;

 private:
  CameraModel model_;
  CloudConfig config_;
  DepthCamera camera_;
};

}  // namespace doorforge
