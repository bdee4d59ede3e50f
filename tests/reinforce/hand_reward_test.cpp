// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/hand_reward.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace doorforge {
namespace {

constexpr HandRewardConfig kPlain{.scale = 1};
const std::vector<float> kStill(7);

HandInstant AtTheGrasp() {
  HandInstant instant;
  instant.state.world_from_grasp.translation() = Eigen::Vector3d(1, 2, 3);
  instant.state.world_from_tcp = instant.state.world_from_grasp;
  instant.state.handle_done_rad = 0.6;
  return instant;
}

// DoorGym's numbers by hand, term by term.
TEST(HandReward, IsTheSumOfItsTerms) {
  HandInstant instant = AtTheGrasp();
  const double there = -std::log(0.005) - 5;
  EXPECT_NEAR(HandReward(instant, kStill, kPlain), there, 1e-12);

  instant.state.world_from_tcp.translation() += Eigen::Vector3d(0, 0.06, 0.08);
  EXPECT_NEAR(HandReward(instant, kStill, kPlain), -0.1 - std::log(0.015) - 5, 1e-12);

  instant = AtTheGrasp();
  instant.state.hinge_rad = 0.2;
  instant.state.handle_rad = 0.4;
  instant.pads = {true, false};
  EXPECT_NEAR(HandReward(instant, kStill, kPlain), there + 30 * 0.2 + 50 * 0.4 + 0.5, 1e-9);
  EXPECT_NEAR(HandReward(instant, kStill, {.scale = 0.02}),
              0.02 * (there + 30 * 0.2 + 50 * 0.4 + 0.5), 1e-9);

  std::vector<float> action(7);
  action[0] = 0.5F;
  action[6] = -3;  // counts as -1
  EXPECT_NEAR(HandReward(AtTheGrasp(), action, kPlain), there - 1.25 / 7, 1e-9);
}

TEST(HandReward, CountsAnglesUpToTheirCaps) {
  HandInstant instant = AtTheGrasp();
  const double closed = HandReward(instant, kStill, kPlain);
  instant.state.hinge_rad = 2;
  instant.state.handle_rad = 0.8;
  EXPECT_NEAR(HandReward(instant, kStill, kPlain) - closed, 30 * 0.9 + 50 * 0.6, 1e-9);
  instant.state.hinge_rad = instant.state.handle_rad = -1;
  EXPECT_NEAR(HandReward(instant, kStill, kPlain), closed, 1e-9);
}

// The fingers are alike: a hand that is upside down holds as well.
TEST(HandReward, KnowsThatTheFingersAreAlike) {
  HandInstant instant = AtTheGrasp();
  const double straight = HandReward(instant, kStill, kPlain);
  instant.state.world_from_tcp =
      instant.state.world_from_grasp * RotationAbout(Eigen::Vector3d::UnitZ(), std::acos(-1.0));
  EXPECT_NEAR(HandReward(instant, kStill, kPlain), straight, 1e-6);
  instant.state.world_from_tcp =
      instant.state.world_from_grasp * RotationAbout(Eigen::Vector3d::UnitX(), 0.3);
  EXPECT_NEAR(HandReward(instant, kStill, kPlain), straight - 0.3, 1e-6);
}

}  // namespace
}  // namespace doorforge
