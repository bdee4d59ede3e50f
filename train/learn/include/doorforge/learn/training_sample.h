// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "doorforge/schemas/policy.h"

namespace doorforge {

/// One decision of a stage, as the networks see it (UniDoorManip 4.2).
struct TrainingSample {
  /// 4096 x 3, world [m]; point 0 is the visible point nearest to the hand. Not owned.
  std::span<const float> cloud;
  PolicyState state{};
  std::array<float, 3> hand_m{};  ///< World.
  std::array<float, 3> base_m{};  ///< World.
  ActionVector action{};          ///< What the expert did.
  float score_rad = 0;            ///< What the action gained: the critic's target.
};

}  // namespace doorforge
