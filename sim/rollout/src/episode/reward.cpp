// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/reward.h"

#include <algorithm>

namespace doorforge {

double OpeningReward(const Transition& transition) {
  return transition.after.hinge_rad - transition.before.hinge_rad;
}

double HandleReward(const Transition& transition) {
  return transition.after.handle_rad - transition.before.handle_rad;
}

double GraspRating(const PrivilegedState& end) { return std::max(0.0, end.hinge_rad); }

double RewardOf(Stage stage, const Transition& transition) {
  switch (stage) {
    case Stage::kOpen:
      return OpeningReward(transition);
    case Stage::kHandle:
      return HandleReward(transition);
    case Stage::kGrasp:
      return GraspRating(transition.after);
  }
  return 0;
}

}  // namespace doorforge
