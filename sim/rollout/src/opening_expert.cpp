// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/opening_expert.h"

#include <algorithm>

namespace doorforge {
namespace {

RigidTransform TurnAbout(const Eigen::Vector3d& origin, const Eigen::Vector3d& axis, double angle) {
  return Translation(origin) * RotationAbout(axis, angle) * Translation(-origin);
}

double DistanceToAxis(const Eigen::Vector3d& point, const Eigen::Vector3d& origin,
                      const Eigen::Vector3d& axis) {
  return axis.cross(point - origin).norm();
}

}  // namespace

void OpeningExpert::Reset() { actions_ = 0; }

Action OpeningExpert::Act(const Observation& observation) {
  const PrivilegedState& now = observation.privileged;
  if (actions_ == 0) {
    // as it is held at this moment: turning the handle may have shifted the grasp
    handle_from_hand_ = now.world_from_handle.inverse() * now.world_from_hand;
    handle_target_rad_ = now.handle_rad + config_.press_rad;
  }
  if (now.hinge_rad > config_.ajar_rad)
    handle_target_rad_ = std::max(0.0, handle_target_rad_ - config_.relax_rad_per_action);

  const double reach = std::max(DistanceToAxis(now.world_from_hand.translation(),
                                               now.hinge_origin_in_world, now.hinge_axis_in_world),
                                0.1);
  const double ramp = std::min(1.0, actions_ / 4.0);
  const double full = std::max(config_.step_m, config_.least_turn_rad * reach);
  const double arc = config_.first_step_m + ramp * (full - config_.first_step_m);
  const RigidTransform open =
      TurnAbout(now.hinge_origin_in_world, now.hinge_axis_in_world, arc / reach);
  const RigidTransform turn = TurnAbout(now.handle_origin_in_world, now.handle_axis_in_world,
                                        handle_target_rad_ - now.handle_rad);
  const RigidTransform target = open * turn * now.world_from_handle * handle_from_hand_;
  ++actions_;
  return {target.translation() - now.world_from_hand.translation(), target.linear()};
}

}  // namespace doorforge
