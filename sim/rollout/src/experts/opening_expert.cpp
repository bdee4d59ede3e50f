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

// Whether the opening door moves away from the hand.
bool IsPushed(const PrivilegedState& now) {
  const Eigen::Vector3d arm = now.world_from_hand.translation() - now.hinge_origin_in_world;
  return now.hinge_axis_in_world.cross(arm).dot(now.world_from_hand.linear().col(2)) > 0;
}

// Turned back by an angle of the hinge about the pads' own normal, on which they turn most easily.
RigidTransform KeepingItsHeading(const RigidTransform& hand, const Eigen::Vector3d& hinge_axis,
                                 double hinge_rad, double tool_m) {
  const RigidTransform hand_from_tool = Translation({0, 0, tool_m});
  const double along = hand.linear().col(1).dot(hinge_axis);
  return hand * hand_from_tool * RotationAbout(Eigen::Vector3d::UnitY(), -hinge_rad * along) *
         hand_from_tool.inverse();
}

}  // namespace

void OpeningExpert::Reset() { actions_ = 0; }

Action OpeningExpert::Act(const Observation& observation) {
  const PrivilegedState& now = observation.privileged;
  if (actions_ == 0) {
    // as it is held at this moment: turning the handle may have shifted the grasp
    handle_from_hand_ = now.world_from_handle.inverse() * now.world_from_hand;
    handle_target_rad_ = now.handle_rad + config_.press_rad;
    pushes_ = IsPushed(now);
  }
  if (now.hinge_rad > config_.ajar_rad && !now.door.relatches)
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
  RigidTransform target = open * turn * now.world_from_handle * handle_from_hand_;
  if (pushes_)
    target =
        KeepingItsHeading(target, now.hinge_axis_in_world,
                          config_.push_yaw_share * (now.hinge_rad + arc / reach), config_.tool_m);
  ++actions_;
  return {target.translation() - now.world_from_hand.translation(), target.linear()};
}

}  // namespace doorforge
