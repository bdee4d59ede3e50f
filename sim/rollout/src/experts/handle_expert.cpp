// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/handle_expert.h"

#include <algorithm>

namespace doorforge {

Action HandleExpert::Act(const Observation& observation) {
  const PrivilegedState& now = observation.privileged;
  if (actions_ == 0) handle_from_hand_ = now.world_from_handle.inverse() * now.world_from_hand;
  // a hand that has turned on the handle goes on from where it is, within limits
  const RigidTransform slip =
      now.world_from_handle * handle_from_hand_ * now.world_from_hand.inverse();
  const double ahead = -RotationVector(slip.linear()).dot(now.handle_axis_in_world);
  const double step = (actions_ == 0 ? config_.first_step_rad : config_.step_rad) +
                      std::clamp(ahead, 0.0, config_.most_slip_rad);
  const RigidTransform turn = Translation(now.handle_origin_in_world) *
                              RotationAbout(now.handle_axis_in_world, step) *
                              Translation(-now.handle_origin_in_world);
  const RigidTransform target = turn * now.world_from_handle * handle_from_hand_;
  ++actions_;
  return {target.translation() - now.world_from_hand.translation(), target.linear()};
}

}  // namespace doorforge
