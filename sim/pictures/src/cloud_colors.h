// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "doorforge/schemas/cloud.h"
#include "doorforge/schemas/shard.h"
#include "doorforge/sensor/depth_camera.h"
#include "doorforge/sensor/pinhole_view.h"

namespace doorforge {

/// What a camera saw that points were made of.
struct ColoredLook {
  const DepthImage* depth = nullptr;
  PinholeView view;               ///< The points were made with it.
  std::vector<std::uint8_t> rgb;  ///< sRGB, height x width x 3.
};

/// The colours of the points of clouds, cloud by cloud.
class CloudColors {
 public:
  /// Each point has the colour of the pixel that it was made of, in the first of the looks that has
  /// it. Throws Error(kInvalidArgument) if none has, or the cloud's size is not the first one's.
  void Add(const LabelledCloud& cloud, std::span<const ColoredLook> looks);

  /// "cloud_rgb.npy" of what was added.
  MemberBytes Member() const;

 private:
  std::string bytes_;
  std::size_t clouds_ = 0;
  std::size_t points_ = 0;
};

}  // namespace doorforge
