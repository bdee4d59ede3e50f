// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "doorforge/sensor/depth_camera.h"
#include "doorforge/sensor/lens.h"
#include "doorforge/sensor/pinhole_view.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// A real depth camera: what turns the numbers of its pictures into points in the world.
struct CalibratedCamera {
  PinholeView view;
  double metres_per_unit = 0.001;  ///< Of pictures in whole numbers.
  double metres_per_float = 1;     ///< Of pictures in floating-point numbers.
  LensDistortion lens{};
  /// Where the pixels of `view` look through `lens`: see WithLens(). Null for a pinhole.
  std::shared_ptr<const PixelDirections> directions{};
};

/// Gives the same camera with a lens before it.
///
/// @throws Error(kInvalidArgument) as Lens, and if most of the pixels see nothing through it, with
///     how many: coefficients of another lens or in another order.
CalibratedCamera WithLens(CalibratedCamera camera, const LensDistortion& lens);

/// Gives the same camera with a whole number of times as many pixels along each side.
CalibratedCamera WithFinerPixels(CalibratedCamera camera, int times);

/// CropCloud() through the camera's lens.
LabelledCloud CropCloud(const DepthImage& depth, const CalibratedCamera& camera,
                        const CloudConfig& config = {});

/// Reads a camera file, docs/act.md: our own, with or without a ROS camera_info that it names, or
/// such a camera_info with our keys in it. Throws Error(kInvalidConfig) on keys that are missing or
/// unknown and on numbers out of range, naming them; Error(kMissing).
CalibratedCamera ReadCalibratedCamera(const std::filesystem::path& path);

}  // namespace doorforge
