// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/rollout/camera_observer.h"

namespace doorforge {

/// How much of what would be seen of a link, stood it there alone, is hidden; in shares of the
/// camera's pixels, 0..1. A link that is out of the picture has zeros. What a link hides of itself
/// (its back) is not counted.
struct HiddenShare {
  double by_robot = 0;  ///< Seen without the robot, but not with it.
  double by_door = 0;   ///< Hidden by the rest of the door, with or without the robot.
};

struct Occlusion {
  HiddenShare handle;
  HiddenShare leaf;
};

/// Measures one door's occlusion. Serves one thread at a time; costs three more depth images.
class OcclusionMeter {
 public:
  explicit OcclusionMeter(const DoorAsset& door);

  /// @param seen Ideal image of robot and door, rendered with `camera` at these poses.
  Occlusion Measure(const DepthImage& seen, const CameraModel& camera,
                    const SceneSnapshot& snapshot);

 private:
  DepthCamera door_;
  DepthCamera leaf_;
  DepthCamera handle_;
};

}  // namespace doorforge
