// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/core/rigid_transform.h"
#include "doorforge/schemas/camera_model.h"

namespace doorforge {

/// Intrinsics and pose of a pinhole camera without distortion, as a calibration gives them; pixels
/// need not be square, nor the optical axis in the middle.
struct PinholeView {
  int width = 0;  ///< Pixels.
  int height = 0;
  double fx = 0;  ///< Focal lengths [pixels].
  double fy = 0;
  double cx = 0;  ///< Where the optical axis meets the image [pixels]; the first pixel has its
  double cy = 0;  ///< centre at (0.5, 0.5).
  /// OpenCV convention: camera x to the right, y down, z forward.
  RigidTransform world_from_camera = RigidTransform::Identity();
};

/// The simulated camera as one of these.
PinholeView ViewOf(const CameraModel& camera);

}  // namespace doorforge
