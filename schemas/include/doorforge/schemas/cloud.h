// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace doorforge {

/// What a point of the cloud belongs to.
enum class PointLabel : std::uint8_t { kBody = 0, kHandle, kFrame, kRobot, kOther };
inline constexpr int kPointLabelCount = 5;

/// What a camera saw; both arrays row by row from the top left.
struct CameraPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< sRGB, height x width x 3.
  std::vector<float> depth_m;     ///< Along the optical axis; infinity where nothing was seen.
};

/// Points seen by a camera, in the world frame.
struct LabelledCloud {
  std::vector<float> xyz;           ///< [m], N x 3, row by row.
  std::vector<std::uint8_t> label;  ///< PointLabel values, length N.
  /// Colours of the pixels that the points were made of, sRGB, N x 3; empty: nobody looked at them.
  std::vector<std::uint8_t> rgb{};
  /// The picture that the points were made of, where colours were looked at; null otherwise, and
  /// in a mirror.
  std::shared_ptr<const CameraPicture> picture{};
};

}  // namespace doorforge
