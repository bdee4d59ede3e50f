// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/reward.h"

#include <vector>

#include <gtest/gtest.h>

namespace doorforge {
namespace {

// A hand that goes round the hinge on an arc of s at a reach of r turns the door by s / r.
TEST(Reward, OfOpeningIsTheArcOverTheReach) {
  constexpr double kReach = 0.7;
  EXPECT_DOUBLE_EQ(OpeningReward({0.1, 0.5}, {0.1 + 0.05 / kReach, 0.2}), 0.05 / kReach);
  EXPECT_DOUBLE_EQ(OpeningReward({0.1, 0}, {0.04, 0.3}), -0.06);  // the spring pulled it back
}

TEST(Reward, OfTheHandleIsItsTurnAndNotTheDoors) {
  EXPECT_DOUBLE_EQ(HandleReward({0.2, 0.1}, {0.9, 0.35}), 0.25);
  EXPECT_DOUBLE_EQ(HandleReward({0.2, 0.35}, {0.2, 0}), -0.35);
}

TEST(Reward, OfAGraspIsTheDoorsFinalAngleAndNeverLess) {
  EXPECT_DOUBLE_EQ(GraspRating({0.8, 0.4}), 0.8);
  EXPECT_DOUBLE_EQ(GraspRating({-0.002, 0.4}), 0);
}

TEST(Reward, AddsUpToTheWholeWayHoweverItIsCutIntoActions) {
  const std::vector<DoorAngles> way = {{0, 0}, {0.1, 0.4}, {0.05, 0.5}, {0.6, 0.2}, {0.9, 0}};
  double hinge = 0;
  double handle = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    hinge += RewardOf(Stage::kOpen, way[i - 1], way[i]);
    handle += RewardOf(Stage::kHandle, way[i - 1], way[i]);
  }
  EXPECT_NEAR(hinge, 0.9, 1e-12);
  EXPECT_NEAR(handle, 0, 1e-12);
  EXPECT_DOUBLE_EQ(RewardOf(Stage::kGrasp, way[0], way[3]), 0.6);
}

}  // namespace
}  // namespace doorforge
