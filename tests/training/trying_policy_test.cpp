// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/trying_policy.h"

#include <memory>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/policy/stage_policy.h"

#include "synthetic_samples.h"

namespace doorforge {
namespace {

constexpr double kStep = 0.02;  // [m]

Proprioception HandAt(const Eigen::Vector3d& place, const Eigen::Matrix3d& rotation) {
  Proprioception proprioception{};
  const Eigen::Quaterniond q(rotation);
  const std::vector<double> numbers{place.x(), place.y(), place.z(), q.x(), q.y(), q.z(), q.w()};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    proprioception[25 + i] = static_cast<float>(numbers[i]);
  return proprioception;
}

// Asks for a shift, or for a turn about x, to one side or the other.
class ToAndFro : public TwoWayPolicy {
 public:
  explicit ToAndFro(bool turns) : turns_(turns) {}
  void Reset() override {}
  Action Act(const Observation& observation, MotionWay way) override {
    const double sign = way == MotionWay::kUsual ? 1 : -1;
    Action action;
    action.world_from_hand_rotation = HandRotationOf(observation.proprioception);
    if (turns_)
      action.world_from_hand_rotation =
          RotationAbout(Eigen::Vector3d::UnitX(), sign * 0.2).linear() *
          action.world_from_hand_rotation;
    else
      action.position_delta_m.x() = sign * kStep;
    return action;
  }

 private:
  bool turns_;
};

// A hand that does a share of what is asked, one for either sense of x.
class Hand {
 public:
  Hand(double forward, double backward) : forward_(forward), backward_(backward) {}
  Observation Seen() const {
    Observation observation;
    observation.proprioception = HandAt(place_, rotation_);
    return observation;
  }
  void Do(const Action& action) {
    const Eigen::Vector3d turn =
        RotationVector(action.world_from_hand_rotation * rotation_.transpose());
    const double x = action.position_delta_m.x() + turn.x();
    const double share = x > 0 ? forward_ : backward_;
    place_ += share * action.position_delta_m;
    rotation_ = RotationAbout(Eigen::Vector3d::UnitX(), share * turn.x()).linear() * rotation_;
  }

 private:
  double forward_;
  double backward_;
  Eigen::Vector3d place_ = {0.3, 0.1, 1};
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();
};

std::vector<MotionWay> WaysTaken(Hand hand, bool turns, int actions) {
  TryingPolicy policy(std::make_unique<ToAndFro>(turns), {});
  policy.Reset();
  std::vector<MotionWay> ways;
  for (int i = 0; i < actions; ++i) {
    hand.Do(policy.Act(hand.Seen()));
    ways.push_back(policy.way());
  }
  return ways;
}

TEST(TryingPolicy, GoesTheOtherWayOnceTheUsualLeadsNowhere) {
  constexpr auto kUsual = MotionWay::kUsual;
  constexpr auto kOther = MotionWay::kOther;
  for (const bool turns : {false, true}) {
    EXPECT_EQ(WaysTaken({1, 0}, turns, 8), std::vector(8, kUsual));
    EXPECT_EQ(WaysTaken({0.5, 0}, turns, 8), std::vector(8, kUsual));
    const std::vector<MotionWay> changed{kUsual, kUsual, kUsual, kOther,
                                         kOther, kOther, kOther, kOther};
    EXPECT_EQ(WaysTaken({0, 1}, turns, 8), changed);
    EXPECT_EQ(WaysTaken({0.1, 0.8}, turns, 8), changed);
    const std::vector<MotionWay> nowhere{kUsual, kUsual, kUsual, kOther,
                                         kOther, kOther, kUsual, kUsual};
    EXPECT_EQ(WaysTaken({0, 0}, turns, 8), nowhere);
  }
}

TEST(TryingPolicy, WhatIsTakenBackDoesNotCount) {
  TryingPolicy policy(std::make_unique<ToAndFro>(false), {});
  const Hand still(0, 0);
  for (int i = 0; i < 20; ++i) {
    policy.Act(still.Seen());
    policy.TakeBack();
    EXPECT_EQ(policy.way(), MotionWay::kUsual);
  }
}

TEST(TryingPolicy, RefusesSettingsOutOfRange) {
  EXPECT_THROW(TryingPolicy(std::make_unique<ToAndFro>(false), {.patience = 0}), Error);
  EXPECT_THROW(TryingPolicy(std::make_unique<ToAndFro>(false), {.moved_share = 1.5}), Error);
}

// Whether a policy does something else once the hand has not moved for three actions.
bool ChangesItsMind(const std::vector<TrainingSample>& samples) {
  const NetworkView view{ViewFrame::kHand, StateKind::kHand};
  const auto policy = MakePolicy(InitialNetworks(MeasureNormalisation(samples, view), false, 4));
  Observation observation;
  observation.proprioception = samples.front().proprioception;
  observation.cloud.xyz.assign(samples.front().cloud.begin(), samples.front().cloud.end());
  policy->Reset();
  const Action first = policy->Act(observation);
  EXPECT_EQ(policy->Act(observation).position_delta_m, first.position_delta_m);
  EXPECT_EQ(policy->Act(observation).position_delta_m, first.position_delta_m);
  return policy->Act(observation).position_delta_m != first.position_delta_m;
}

TEST(TryingPolicy, IsWhatNetworksOfBothWaysBecome) {
  auto made = testing::MakeSyntheticSamples(5, 4);
  EXPECT_FALSE(ChangesItsMind(made.samples));
  made.samples[1].way = MotionWay::kOther;
  EXPECT_TRUE(ChangesItsMind(made.samples));
}

}  // namespace
}  // namespace doorforge
