// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/hand_reward.h"

#include <algorithm>
#include <cmath>

#include "doorforge/policy/hand_network.h"

namespace doorforge {
namespace {

double MeanSquare(std::span<const float> action) {
  double sum = 0;
  for (const float a : action) {
    const double clipped = std::clamp(double{a}, -1.0, 1.0);
    sum += clipped * clipped;
  }
  return sum / static_cast<double>(action.size());
}

}  // namespace

double HandReward(const HandInstant& after, std::span<const float> action,
                  const HandRewardConfig& config) {
  const HandState& state = after.state;
  const double d =
      (state.world_from_grasp.translation() - state.world_from_tcp.translation()).norm();
  const double near = -d - std::log(d * d + 0.005) - 5;
  const double turn = TurnToGrasp(state).norm();
  const double hinge = std::clamp(state.hinge_rad, 0.0, config.door_most_rad);
  const double handle = std::clamp(state.handle_rad, 0.0, state.handle_done_rad);
  const double pads = (after.pads[0] ? 0.5 : 0) + (after.pads[1] ? 0.5 : 0);
  return config.scale * (near - config.turn * turn + config.door * hinge + config.handle * handle -
                         config.effort * MeanSquare(action) + config.grasp * pads);
}

}  // namespace doorforge
