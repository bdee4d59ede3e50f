// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

#include "doorforge/dataset/collect.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/pictures/pictures_config.h"
#include "doorforge/rollout/grasp_camera.h"
#include "doorforge/rollout/remembered_view.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// How an existing dataset is looked at again. By default as it was: same camera, same cloud.
struct ReobserveConfig {
  /// False: only the door is seen, as if nobody stood before it. What was looked at without the
  /// robot, as at the stage "grasp", stays so.
  bool robot = true;
  bool own_camera = false;  ///< True: `camera` for all episodes; false: each episode's own.
  CameraConfig camera;
  GraspCameraConfig grasp_camera;   ///< At "grasp".
  RememberedViewConfig remembered;  ///< At "handle".
  CloudConfig cloud;
  bool preview = true;
  PicturesConfig pictures;  ///< Written into files only where there are any.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("robot", self.robot);
    visit("own_camera", self.own_camera);
    visit("camera", self.camera);
    visit("grasp_look", self.grasp_camera);
    visit("remembered", self.remembered);
    visit("cloud", self.cloud);
    visit("preview", self.preview);
    if (!std::is_const_v<Self> || self.pictures.IsOn()) visit("pictures", self.pictures);
  }
};

struct ReobserveRequest {
  std::filesystem::path folder;    ///< It holds the existing dataset.
  std::filesystem::path out;       ///< It receives the new one.
  std::vector<std::string> doors;  ///< Folders with the doors of the dataset.
  std::string config;              ///< File with settings; empty: none.
  std::vector<std::string> settings;
  std::string robot;  ///< URDF of the robot, where config.yaml names one; see RecordedRobot().
  RobotMeshReader robot_meshes;  ///< Reads the meshes of that robot; see LoadRobot().
  bool without_robot = false;
  int threads = 0;
};

/// Renders the clouds of a dataset anew from its stored joint states, without physics. Everything
/// but clouds, labels, previews, pictures and what meta.json says of the look stays as it is; keys,
/// shards and failures too, so that the two datasets are pairs. With the settings as they were, the
/// clouds are the same, byte by byte. Of the stage "grasp", point 0 of a cloud is the visible point
/// nearest to the contact. Stopped, the same call goes on. Locks the new
/// folder meanwhile.
///
/// @throws Error(kInvalidArgument) if the dataset holds no joint states (those of earlier builds),
///     if a door is not in `doors` or not the one of the dataset, or as Collect(); Error(kMissing
///     or kFormat) as the readers; Error(kInvalidConfig).
CollectSummary ReobserveDataset(const ReobserveRequest& request);

}  // namespace doorforge
