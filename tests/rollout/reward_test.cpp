// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/reward.h"

#include <gtest/gtest.h>

namespace doorforge {
namespace {

PrivilegedState At(double hinge_rad, double handle_rad) {
  PrivilegedState state;
  state.hinge_rad = hinge_rad;
  state.handle_rad = handle_rad;
  return state;
}

// A hand that goes round the hinge on an arc of s at a reach of r turns the door by s / r.
TEST(Reward, OfOpeningIsTheArcOverTheReach) {
  constexpr double kReach = 0.7;
  const PrivilegedState begin = At(0.1, 0.5);
  EXPECT_DOUBLE_EQ(OpeningReward({begin, At(0.1 + 0.05 / kReach, 0.2), {}}), 0.05 / kReach);
  EXPECT_DOUBLE_EQ(OpeningReward({begin, At(0.04, 0.3), {}}), -0.06);  // the spring pulled it back
}

TEST(Reward, OfTheHandleIsItsTurnAndNotTheDoors) {
  EXPECT_DOUBLE_EQ(HandleReward({At(0.2, 0.1), At(0.9, 0.35), {}}), 0.25);
  EXPECT_DOUBLE_EQ(HandleReward({At(0.2, 0.35), At(0.2, 0), {}}), -0.35);
}

TEST(Reward, OfAGraspIsTheDoorsFinalAngleAndNeverLess) {
  EXPECT_DOUBLE_EQ(GraspRating(At(0.8, 0.4)), 0.8);
  EXPECT_DOUBLE_EQ(GraspRating(At(-0.002, 0.4)), 0);
}

TEST(Reward, IsThatOfTheStage) {
  const PrivilegedState before = At(0.05, 0.5);
  const PrivilegedState after = At(0.6, 0.2);
  const Transition step{before, after, {}};
  EXPECT_DOUBLE_EQ(RewardOf(Stage::kOpen, step), OpeningReward(step));
  EXPECT_DOUBLE_EQ(RewardOf(Stage::kHandle, step), HandleReward(step));
  EXPECT_DOUBLE_EQ(RewardOf(Stage::kGrasp, step), GraspRating(after));
}

}  // namespace
}  // namespace doorforge
