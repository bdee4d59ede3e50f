// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/handle_rule.h"

#include <algorithm>

namespace doorforge {

RigidTransform ExpertUnlock::Follow(const PrivilegedState& now) {
  const EpisodeLimits& limits = scene_.limits;
  const double goal = std::min(scene_.latch.handle_done_angle_rad + limits.turn_beyond_rad,
                               door_.handle_joint.upper_rad);
  commanded_rad_ = std::min({commanded_rad_ + limits.turn_speed_rad_s * scene_.physics.time_step_s,
                             now.handle_rad + limits.turn_lead_rad, goal + limits.turn_lead_rad});
  const RigidTransform world_from_handle =
      scene_.world_from_door * DoorFromLinks(door_, now.hinge_rad, commanded_rad_)[kHandleLink];
  return world_from_handle * now.handle_from_hand_at_grasp;
}

}  // namespace doorforge
