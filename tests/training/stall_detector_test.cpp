// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/stall_detector.h"

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rigid_transform.h"

namespace doorforge {
namespace {

constexpr double kStep = 0.01;  // [m]
constexpr double kTurn = 0.05;  // [rad]

Proprioception HandAt(const Eigen::Vector3d& place, const Eigen::Matrix3d& rotation) {
  Proprioception proprioception{};
  const Eigen::Quaterniond q(rotation);
  const std::vector<double> numbers{place.x(), place.y(), place.z(), q.x(), q.y(), q.z(), q.w()};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    proprioception[25 + i] = static_cast<float>(numbers[i]);
  return proprioception;
}

// A hand that does a share of each action, which asks for a shift along x or a turn about it.
class Hand {
 public:
  explicit Hand(bool turns) : turns_(turns) {}

  Proprioception Now() const { return HandAt(place_, rotation_); }
  Action Asked() const {
    if (turns_) return {{0, 0, 0}, TurnedBy(kTurn)};
    return {{kStep, 0, 0}, rotation_};
  }
  void Do(double share) {
    if (turns_)
      rotation_ = TurnedBy(share * kTurn);
    else
      place_.x() += share * kStep;
  }

 private:
  Eigen::Matrix3d TurnedBy(double angle) const {
    return RotationAbout(Eigen::Vector3d::UnitX(), angle).linear() * rotation_;
  }

  bool turns_;
  Eigen::Vector3d place_ = {0.3, 0.1, 1};
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();
};

// After how many actions a hand that does this share of them is said to stall; 0: never in 20.
int StallsAfter(double share, bool turns, const StallConfig& config = {}) {
  Hand hand(turns);
  StallDetector detector(config);
  for (int actions = 0; actions < 20; ++actions) {
    if (detector.Stalls(hand.Now())) return actions;
    detector.Ask(hand.Now(), hand.Asked());
    hand.Do(share);
  }
  return 0;
}

TEST(StallDetector, ANumberOfActionsOfWhichTooLittleIsDoneAreAStall) {
  for (const bool turns : {false, true}) {
    EXPECT_EQ(StallsAfter(0, turns), 3);
    EXPECT_EQ(StallsAfter(0.6, turns), 3);
    EXPECT_EQ(StallsAfter(0.7, turns), 0);
    EXPECT_EQ(StallsAfter(0, turns, {.patience = 5}), 5);
    EXPECT_EQ(StallsAfter(0.3, turns, {.moved_share = 0.25}), 0);
  }
}

TEST(StallDetector, AHandThatHasComeFartherIsHeldUpOnTheRightWay) {
  for (const bool turns : {false, true}) {
    Hand hand(turns);
    StallDetector detector({});
    for (int actions = 0; actions < 12; ++actions) {
      EXPECT_FALSE(detector.Stalls(hand.Now())) << actions;
      detector.Ask(hand.Now(), hand.Asked());
      hand.Do(actions < 5 ? 1 : 0);  // 5 cm, or 0.25 rad, which count as 2.5 cm
    }
  }
}

TEST(StallDetector, WhatIsTakenBackDoesNotCount) {
  const Hand still(false);
  StallDetector detector({});
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(detector.Stalls(still.Now()));
    detector.Ask(still.Now(), still.Asked());
    detector.TakeBack();
  }
}

TEST(StallDetector, BeginsAnewAfterAReset) {
  const Hand still(false);
  StallDetector detector({});
  for (int i = 0; i < 3; ++i) detector.Ask(still.Now(), still.Asked());
  EXPECT_TRUE(detector.Stalls(still.Now()));
  detector.Reset();
  EXPECT_FALSE(detector.Stalls(still.Now()));
}

TEST(StallDetector, RefusesSettingsOutOfRange) {
  EXPECT_NO_THROW(StallDetector({}));
  EXPECT_THROW(StallDetector({.patience = 0}), Error);
  EXPECT_THROW(StallDetector({.moved_share = 1.5}), Error);
}

}  // namespace
}  // namespace doorforge
