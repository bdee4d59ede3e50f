// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/belief_grasp.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "doorforge/core/rigid_transform.h"

namespace doorforge {
namespace {

constexpr double kLeanRad = 0.35;
constexpr double kSideways = 0.7;  // of the closing direction, level

}  // namespace

Eigen::Matrix3d ClearOfTheJamb(const Eigen::Matrix3d& world_from_hand, HingeSide side) {
  // who looks at the door has the world's y to the right
  const double to_hinge = side == HingeSide::kLeft ? -1 : 1;
  Eigen::Matrix3d hand = world_from_hand;
  if (std::abs(hand.col(1).y()) > kSideways)
    hand = hand * RotationAbout(Eigen::Vector3d::UnitZ(), std::numbers::pi / 2).linear();
  return hand * RotationAbout(Eigen::Vector3d::UnitY(), -kLeanRad * to_hinge * hand(1, 0)).linear();
}

std::optional<GraspAction> BeliefGrasp::Choose(const GraspObservation& seen) {
  GraspObservation observation = seen;
  guesses_.resize(seen.tried.size());
  if (!seen.tried.empty()) {
    const DoorGuess& now = belief_->ForGrasp(seen.tried.back().contact_m.cast<float>());
    observation.tried.clear();
    for (std::size_t i = 0; i < guesses_.size(); ++i)
      if (guesses_[i] == now) observation.tried.push_back(seen.tried[i]);
  }
  std::optional<GraspAction> action = policy_->Choose(observation);
  if (!action) return action;
  const DoorGuess& guess = belief_->ForGrasp(action->contact_m.cast<float>());
  guesses_.push_back(guess);
  if (guess.opening == MotionWay::kOther)
    action->world_from_hand_rotation = ClearOfTheJamb(action->world_from_hand_rotation, guess.side);
  return action;
}

}  // namespace doorforge
