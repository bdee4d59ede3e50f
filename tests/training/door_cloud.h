// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace doorforge::testing {

/// 4096 points [m], 4096 x 3, on a door leaf open by `hinge_rad`, its frame and its handle, with
/// noise of 2 mm. Point 0 lies on the handle. Same arguments, same cloud.
std::vector<float> DoorCloud(std::uint64_t seed, double hinge_rad);

}  // namespace doorforge::testing
