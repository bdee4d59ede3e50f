// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace doorforge {

/// What a point of the cloud belongs to.
enum class PointLabel : std::uint8_t { kBody = 0, kHandle, kFrame, kRobot, kOther };
inline constexpr int kPointLabelCount = 5;

/// Points seen by a camera, in the world frame.
struct LabelledCloud {
  std::vector<float> xyz;           ///< [m], N x 3, row by row.
  std::vector<std::uint8_t> label;  ///< PointLabel values, length N.
  /// Colours of the pixels that the points were made of, sRGB, N x 3; empty: nobody looked at them.
  std::vector<std::uint8_t> rgb{};
};

}  // namespace doorforge
