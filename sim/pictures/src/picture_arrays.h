// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/schemas/picture_streams.h"
#include "doorforge/schemas/shard.h"
#include "doorforge/sensor/depth_camera.h"

namespace doorforge {

/// A look of one camera. Depth has the sensor's noise, the rest has none.
struct CameraPixels {
  const DepthImage& depth;
  const SurfaceImage& surfaces;
  RigidTransform world_from_camera;
  std::span<const std::uint8_t> rgb;  ///< Height x width x 3; empty where it is not asked for.
};

/// The arrays of one camera, look by look.
class PictureArrays {
 public:
  PictureArrays(std::string camera, const std::vector<PictureStream>& streams);

  void Add(const CameraPixels& pixels);
  /// The members, from what was added; this is empty afterwards.
  void MoveTo(std::vector<MemberBytes>& members);

 private:
  struct Array {
    PictureStream stream;
    std::string bytes;
  };

  std::string camera_;
  std::vector<Array> arrays_;
  std::string poses_;
  std::size_t looks_ = 0;
  std::size_t width_ = 0;
  std::size_t height_ = 0;
};

}  // namespace doorforge
