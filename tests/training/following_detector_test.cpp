// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/following_detector.h"

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

// Fingers from -1, closed, to 1; the hand `way_m` along y from where it began.
Proprioception Hand(float way_m, float finger) {
  Proprioception proprioception{};
  proprioception[9] = proprioception[10] = finger;
  proprioception[26] = way_m;
  return proprioception;
}

bool FollowsAfter(const FollowingConfig& config, float way_m, float finger) {
  FollowingDetector detector(config);
  EXPECT_FALSE(detector.Follows(Hand(0, 0)));
  return detector.Follows(Hand(way_m, finger));
}

TEST(FollowingDetector, WantsTheWayAndTheFingersApart) {
  const FollowingConfig config{.way_m = 0.1, .kept_share = 0.8};
  EXPECT_TRUE(FollowsAfter(config, 0.11F, 0));
  EXPECT_FALSE(FollowsAfter(config, 0.09F, 0));
  // the gap is 2 at the beginning: 1.7 and 1.5 now
  EXPECT_TRUE(FollowsAfter(config, 0.11F, -0.15F));
  EXPECT_FALSE(FollowsAfter(config, 0.11F, -0.25F));
}

TEST(FollowingDetector, BeginsAnewAfterAReset) {
  FollowingDetector detector({.way_m = 0.1});
  detector.Follows(Hand(0, 0));
  detector.Reset();
  EXPECT_FALSE(detector.Follows(Hand(0.5F, 0)));
  EXPECT_TRUE(detector.Follows(Hand(0.7F, 0)));
}

TEST(FollowingDetector, RefusesSettingsOutOfRange) {
  EXPECT_THROW(FollowingDetector({.way_m = 0}), Error);
  EXPECT_THROW(FollowingDetector({.kept_share = 1.1}), Error);
}

}  // namespace
}  // namespace doorforge
