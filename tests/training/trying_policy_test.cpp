// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/trying_policy.h"

#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/policy/stage_policy.h"
#include "doorforge/schemas/mirror.h"

#include "synthetic_samples.h"

namespace doorforge {
namespace {

constexpr double kStep = 0.02;  // [m]
const std::vector<MotionWay> kBothWays = {MotionWay::kUsual, MotionWay::kOther};

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
  TryingPolicy policy(std::make_unique<ToAndFro>(turns), {}, kBothWays, nullptr);
  policy.Reset();
  std::vector<MotionWay> ways;
  for (int i = 0; i < actions; ++i) {
    hand.Do(policy.Act(hand.Seen()));
    ways.push_back(policy.guess().way);
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
  TryingPolicy policy(std::make_unique<ToAndFro>(false), {}, kBothWays, nullptr);
  const Hand still(0, 0);
  for (int i = 0; i < 20; ++i) {
    policy.Act(still.Seen());
    policy.TakeBack();
    EXPECT_EQ(policy.guess().way, MotionWay::kUsual);
  }
}

TEST(TryingPolicy, RefusesSettingsOutOfRange) {
  const auto make = [](const StallConfig& stall) {
    TryingPolicy(std::make_unique<ToAndFro>(false), stall, kBothWays, nullptr);
  };
  EXPECT_NO_THROW(make({}));
  EXPECT_THROW(make({.patience = 0}), Error);
  EXPECT_THROW(make({.moved_share = 1.5}), Error);
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

Observation Mirrored(Observation observation) {
  observation.cloud = MirroredSideways(std::move(observation.cloud));
  observation.proprioception = MirroredSideways(observation.proprioception);
  return observation;
}

std::shared_ptr<SideFinder> Knows(SideChoice side) {
  return std::make_shared<SideFinder>(side, std::nullopt);
}

TEST(TryingPolicy, DoesAtADoorHingedRightTheMirrorImageOfWhatItDoesAtItsMirrorImage) {
  const auto made = testing::MakeSyntheticSamples(5, 4);
  const NetworkView view{ViewFrame::kHand, StateKind::kHand};
  const StageNetworks networks =
      InitialNetworks(MeasureNormalisation(made.samples, view), false, 4);
  const auto left = MakePolicy(networks, {}, Knows(SideChoice::kLeft));
  const auto right = MakePolicy(networks, {}, Knows(SideChoice::kRight));
  for (const TrainingSample& sample : made.samples) {
    Observation observation;
    observation.proprioception = sample.proprioception;
    observation.cloud.xyz.assign(sample.cloud.begin(), sample.cloud.end());
    const Action one = FromVector(MirroredSideways(ToVector(left->Act(observation))));
    const Action other = right->Act(Mirrored(observation));
    EXPECT_EQ(one.position_delta_m, other.position_delta_m);
    EXPECT_EQ(one.world_from_hand_rotation, other.world_from_hand_rotation);
  }
}

// A hand that holds a handle which only goes round a hinge on one side of it.
class HandOnALeaf {
 public:
  explicit HandOnALeaf(double side) : side_(side) {}
  Observation Seen() const {
    Observation observation;
    observation.proprioception = HandAt({0.4 * std::sin(angle_), side_ * 0.4 * std::cos(angle_), 1},
                                        Eigen::Matrix3d::Identity());
    return observation;
  }
  // The leaf takes of an action what lies along its arc.
  void Do(const Action& action) {
    const Eigen::Vector3d arc(std::cos(angle_), -side_ * std::sin(angle_), 0);
    angle_ += action.position_delta_m.dot(arc) / 0.4;
  }

 private:
  double side_;
  double angle_ = 0.6;
};

// Pulls along the arc of a leaf that is hinged left, to the hand's -y.
class PullsLeft : public TwoWayPolicy {
 public:
  void Reset() override {}
  Action Act(const Observation&, MotionWay) override {
    return {{0.02, -0.015, 0}, Eigen::Matrix3d::Identity()};
  }
};

HingeSide SideFoundOn(HandOnALeaf hand) {
  const auto finder = Knows(SideChoice::kAuto);
  finder->Begin(std::nullopt);
  TryingPolicy opens(std::make_unique<PullsLeft>(), {.within_m = 0, .sideways_share = 0.6},
                     {MotionWay::kUsual}, finder);
  for (int i = 0; i < 5; ++i) hand.Do(opens.Act(hand.Seen()));
  return opens.guess().side;
}

TEST(TryingPolicy, NoticesThatTheLeafTakesTheHandToTheOtherSide) {
  EXPECT_EQ(SideFoundOn(HandOnALeaf(1)), HingeSide::kLeft);
  EXPECT_EQ(SideFoundOn(HandOnALeaf(-1)), HingeSide::kRight);
}

TEST(TryingPolicy, TellsTheNextStageOnWhichSideTheHingeIs) {
  const auto finder = Knows(SideChoice::kAuto);
  TryingPolicy turns(std::make_unique<ToAndFro>(true), {}, {MotionWay::kUsual}, finder);
  Hand moves_one_way(0, 1);
  finder->Begin(std::nullopt);
  for (int i = 0; i < 8; ++i) moves_one_way.Do(turns.Act(moves_one_way.Seen()));
  // a turn about x is mirrored into the opposite one
  EXPECT_EQ(turns.guess().side, HingeSide::kRight);
  TryingPolicy opens(std::make_unique<ToAndFro>(false), {}, {MotionWay::kUsual}, finder);
  opens.Reset();
  opens.Act(moves_one_way.Seen());
  EXPECT_EQ(opens.guess().side, HingeSide::kRight);
  finder->Begin(std::nullopt);
  opens.Reset();
  opens.Act(moves_one_way.Seen());
  EXPECT_EQ(opens.guess().side, HingeSide::kLeft);
}

TEST(TryingPolicy, AHandleThatTurnsNeitherWayTellsTheNextStageNothing) {
  const auto finder = Knows(SideChoice::kAuto);
  TryingPolicy turns(std::make_unique<ToAndFro>(true), {}, {MotionWay::kUsual}, finder);
  const Hand fixed(0, 0);
  for (int actions = 1; actions <= 12; ++actions) {
    finder->Begin(std::nullopt);
    turns.Reset();
    for (int i = 0; i < actions; ++i) turns.Act(fixed.Seen());
    EXPECT_EQ(finder->SideFor({0, 0, 0}), HingeSide::kLeft) << actions;
  }
}

TEST(TryingPolicy, APolicyOfTheArmsJointsHasNoMirrorImage) {
  const auto made = testing::MakeSyntheticSamples(5, 4);
  const NetworkView view{ViewFrame::kHand, StateKind::kJoints};
  const StageNetworks networks =
      InitialNetworks(MeasureNormalisation(made.samples, view), false, 4);
  EXPECT_NO_THROW(MakePolicy(networks, {.side = SideChoice::kLeft}));
  EXPECT_THROW(MakePolicy(networks, {.side = SideChoice::kRight}), Error);
}

TEST(TryingPolicy, IsWhatNetworksOfBothWaysBecome) {
  auto made = testing::MakeSyntheticSamples(5, 4);
  EXPECT_FALSE(ChangesItsMind(made.samples));
  made.samples[1].way = MotionWay::kOther;
  EXPECT_TRUE(ChangesItsMind(made.samples));
}

}  // namespace
}  // namespace doorforge
