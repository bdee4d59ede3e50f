// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "film.h"

namespace doorforge::internal {

/// The rule-based expert at the door, in the scene of this seed. `with_cloud`: the camera looks at
/// each decision. Throws as SampleScene() and RunEpisode().
Film FilmOfExpert(const DoorAsset& door, const RobotModel& robot, std::uint64_t seed,
                  bool with_cloud);

}  // namespace doorforge::internal
