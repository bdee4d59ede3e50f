// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "doorforge/rollout/hand_stepper.h"

namespace doorforge {

/// Weights of what one action of a hand is worth. The defaults are DoorGym's but for `scale`,
/// `grasp` and the caps, which are ours.
struct HandRewardConfig {
  double scale = 0.02;         ///< Of the whole, so that values of states are some tens.
  double turn = 1;             ///< Against the turn that the tool is off the grasp [1/rad].
  double door = 30;            ///< For the hinge's angle [1/rad],
  double door_most_rad = 0.9;  ///< up to here.
  double handle = 50;  ///< For the handle's angle [1/rad], up to Latch::handle_done_angle_rad.
  double effort = 1;   ///< Against the mean square of the action's numbers, each clipped to +-1.
  double grasp = 1;    ///< For both pads on the handle; half of it for one.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("scale", self.scale);
    visit("turn", self.turn);
    visit("door", self.door);
    visit("door_most_rad", self.door_most_rad);
    visit("handle", self.handle);
    visit("effort", self.effort);
    visit("grasp", self.grasp);
  }
};

/// What an action was worth that led to `after`; with d the distance of the tool centre from the
/// grasp [m] and t the turn between them [rad]:
///   scale (-d - ln(d^2 + 0.005) - 5 - turn t + door hinge + handle angle - effort mean(a^2)
///          + grasp pads / 2)
/// It is worth of a state more than of a step: who has opened the door goes on earning, so an
/// episode in which it is learned does not end with success.
double HandReward(const HandInstant& after, std::span<const float> action,
                  const HandRewardConfig& config);

}  // namespace doorforge
