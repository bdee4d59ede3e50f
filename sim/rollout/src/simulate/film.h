// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/rollout/camera_observer.h"
#include "doorforge/sensor/picture.h"

namespace doorforge {

/// Takes pictures of an episode from the side while the camera sees it as usual.
class Film : public Observer {
 public:
  Film(const Scene& scene, const DoorAsset& door, const RobotModel& robot);

  LabelledCloud Observe(const SceneSnapshot& snapshot) override;
  void Watch(const SceneSnapshot& snapshot) override;

  /// One PNG: the pictures in their order, and the cloud of the first decision.
  void Write(const std::filesystem::path& path) const;

 private:
  CameraModel model_;
  CameraModel view_;
  CameraObserver camera_;
  SceneGeometry scene_;
  std::vector<Picture> pictures_;
  std::vector<std::string> captions_;
  int decisions_ = 0;
  LabelledCloud first_cloud_;
};

}  // namespace doorforge
