// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/pictures/pictures_config.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/schemas/cloud.h"
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

/// The clouds whose points have colours.
struct PicturedClouds {
  std::vector<const LabelledCloud*> clouds;  ///< Each look has one; they are of equal size.
  const RememberedLook* before = nullptr;    ///< Their other points are from it, if it is there.
};

/// The pictures of an episode.
struct Pictures {
  /// "depth_front.npy" and so on, sorted by name; see PictureStream and kCloudColors. The leading
  /// axis is the looks.
  std::vector<MemberBytes> members;
  /// Each camera has its place, size and intrinsic matrix.
  nlohmann::ordered_json record;
};

/// Takes the pictures of all looks. The noise of depth is drawn for each camera and look from
/// streams "pictures/<door id>/<episode>/<camera>/<look>" of the scene's seed. A point of a cloud
/// has the colour of the pixel that it was made of. A pure function of its arguments and the
/// instruction set; thread-safe.
///
/// @param clouds They are looked at where config.cloud_rgb asks for colours.
/// @throws Error(kInvalidConfig) as CheckPictures(); Error(kInvalidArgument) as DepthCamera, or if
///     the looks have not one cloud each, or a point of one is of no pixel of what was seen.
Pictures TakePictures(const PictureScene& scene, const PicturesConfig& config,
                      std::span<const PictureLook> looks, const PicturedClouds& clouds = {});

}  // namespace doorforge
