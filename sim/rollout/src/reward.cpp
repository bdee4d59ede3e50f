// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/reward.h"

#include <algorithm>

namespace doorforge {

double OpeningReward(const DoorAngles& before, const DoorAngles& after) {
  return after.hinge_rad - before.hinge_rad;
}

double HandleReward(const DoorAngles& before, const DoorAngles& after) {
  return after.handle_rad - before.handle_rad;
}

double GraspRating(const DoorAngles& end) { return std::max(0.0, end.hinge_rad); }

double RewardOf(Stage stage, const DoorAngles& before, const DoorAngles& after) {
  switch (stage) {
    case Stage::kOpen:
      return OpeningReward(before, after);
    case Stage::kHandle:
      return HandleReward(before, after);
    case Stage::kGrasp:
      return GraspRating(after);
  }
  return 0;
}

}  // namespace doorforge
