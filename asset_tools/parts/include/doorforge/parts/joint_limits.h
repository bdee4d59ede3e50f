// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace doorforge::internal {

/// Limits of a door's joints that nothing else states.
struct JointLimits {
  double effort_nm;
  double velocity_rad_s;
};

inline constexpr JointLimits kHingeLimits{300, 6};   ///< Above the latch's 150 and a strong closer.
inline constexpr JointLimits kHandleLimits{30, 12};  ///< A person's strong twist.

}  // namespace doorforge::internal
