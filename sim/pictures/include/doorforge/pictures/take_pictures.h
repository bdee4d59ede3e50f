// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/pictures/pictures_config.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/scene.h"
#include "doorforge/schemas/shard.h"
#include "doorforge/sensor/depth_camera.h"

namespace doorforge {

/// A look of the policies' camera: where everything was, and the depth that its cloud was made of.
struct PictureLook {
  SceneSnapshot snapshot;
  DepthImage depth;
};

/// What is looked at.
struct PictureScene {
  const Scene& scene;  ///< Its camera is the one that the looks were taken with.
  const DoorAsset& door;
  const RobotModel& robot;
  bool sees_robot = true;     ///< False: only the door is there.
  CameraModel as_calibrated;  ///< The scene's camera where calibration believes it to be.
};

/// The pictures of an episode.
struct Pictures {
  /// "depth_front.npy" and so on, sorted by name; see PictureStream. The leading axis is the looks.
  std::vector<MemberBytes> members;
  /// Each camera has its place, size and intrinsic matrix.
  nlohmann::ordered_json record;
};

/// Takes the pictures of all looks. The noise of depth is drawn for each camera and look from
/// streams "pictures/<door id>/<episode>/<camera>/<look>" of the scene's seed. A pure function of
/// its arguments and the instruction set; thread-safe.
///
/// @throws Error(kInvalidConfig) as CheckPictures(); Error(kInvalidArgument) as DepthCamera.
Pictures TakePictures(const PictureScene& scene, const PicturesConfig& config,
                      std::span<const PictureLook> looks);

}  // namespace doorforge
