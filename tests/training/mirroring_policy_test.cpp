// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/mirroring_policy.h"

#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/policy/stage_policy.h"
#include "doorforge/schemas/mirror.h"

#include "synthetic_samples.h"

namespace doorforge {
namespace {

constexpr auto kUsual = MotionWay::kUsual;
constexpr auto kOther = MotionWay::kOther;

std::shared_ptr<DoorBelief> Told(const ToldOfDoor& told) {
  return std::make_shared<DoorBelief>(told, DoorKnowledge{});
}

// Asks for what it sees to one side and above, and says which way it was told to take by x.
class AsksForWhatItSees : public TwoWayPolicy {
 public:
  void Reset() override {}
  Action Act(const Observation& observation, MotionWay way) override {
    Action action;
    action.position_delta_m = {way == kUsual ? 1.0 : -1.0,
                               static_cast<double>(observation.cloud.xyz.at(1)),
                               static_cast<double>(observation.cloud.xyz.at(2))};
    action.world_from_hand_rotation = HandRotationOf(observation.proprioception);
    return action;
  }
};

Observation Seen() {
  Observation observation;
  observation.cloud = {{0.5F, 0.25F, 0.125F}, {0}};
  const Eigen::Quaterniond q(Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()));
  const std::vector<double> numbers{0.1, 0.2, 0.3, q.x(), q.y(), q.z(), q.w()};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    observation.proprioception[25 + i] = static_cast<float>(numbers[i]);
  return observation;
}

Action AskedFor(MirroringRole role) {
  MirroringPolicy policy(std::make_unique<AsksForWhatItSees>(), std::move(role));
  policy.Reset();
  return policy.Act(Seen());
}

TEST(MirroringPolicy, WhatAMirroredPolicySeesAndAnswersComesBackMirrored) {
  // a policy that asks for what it sees does the same in every mirror
  const Observation seen = Seen();
  const Action plain = AskedFor({});
  EXPECT_EQ(plain.position_delta_m, Eigen::Vector3d(1, 0.25, 0.125));
  for (const SideChoice side : {SideChoice::kLeft, SideChoice::kRight}) {
    for (const TurningChoice turning : {TurningChoice::kUsual, TurningChoice::kReversed}) {
      const Action action = AskedFor({Stage::kOpen, false, Told({side, turning})});
      EXPECT_EQ(action.position_delta_m, plain.position_delta_m);
      EXPECT_LT((action.world_from_hand_rotation - HandRotationOf(seen.proprioception)).norm(),
                1e-6);
    }
  }
}

TEST(MirroringPolicy, ShowsEachGuessItsOwnMirrorImage) {
  const auto shown = [](const ToldOfDoor& told) {
    MirroringPolicy policy(std::make_unique<AsksForWhatItSees>(),
                           {Stage::kHandle, false, Told(told)});
    policy.Act(Seen());
    return policy.AsShown(Seen()).cloud.xyz;
  };
  EXPECT_EQ(shown({}), (std::vector<float>{0.5F, 0.25F, 0.125F}));
  EXPECT_EQ(shown({.side = SideChoice::kRight}), (std::vector<float>{0.5F, -0.25F, 0.125F}));
  EXPECT_EQ(shown({.turning = TurningChoice::kReversed}),
            (std::vector<float>{0.5F, 0.25F, -0.125F}));
}

TEST(MirroringPolicy, WhoKnowsBothWaysIsToldWhichOne) {
  const ToldOfDoor reversed{.turning = TurningChoice::kReversed};
  const ToldOfDoor pushed{.opening = OpeningChoice::kPush};
  EXPECT_EQ(AskedFor({Stage::kHandle, true, Told(reversed)}).position_delta_m.x(), -1);
  EXPECT_EQ(AskedFor({Stage::kHandle, false, Told(reversed)}).position_delta_m.x(), 1);
  EXPECT_EQ(AskedFor({Stage::kOpen, true, Told(pushed)}).position_delta_m.x(), -1);
  EXPECT_EQ(AskedFor({Stage::kHandle, true, Told(pushed)}).position_delta_m.x(), 1);
}

StageNetworks SomeNetworks(StateKind state) {
  const auto made = testing::MakeSyntheticSamples(5, 4);
  return InitialNetworks(MeasureNormalisation(made.samples, {ViewFrame::kHand, state}), false, 4);
}

TEST(MirroringPolicy, DoesAtADoorHingedRightTheMirrorImageOfWhatItDoesAtItsMirrorImage) {
  const auto made = testing::MakeSyntheticSamples(5, 4);
  const StageNetworks networks = SomeNetworks(StateKind::kHand);
  const auto left = MakePolicy(networks, {}, Told({}));
  const auto right = MakePolicy(networks, {}, Told({.side = SideChoice::kRight}));
  for (const TrainingSample& sample : made.samples) {
    Observation observation;
    observation.proprioception = sample.proprioception;
    observation.cloud.xyz.assign(sample.cloud.begin(), sample.cloud.end());
    const Action one = FromVector(MirroredSideways(ToVector(left->Act(observation))));
    observation.cloud = MirroredSideways(std::move(observation.cloud));
    observation.proprioception = MirroredSideways(observation.proprioception);
    const Action other = right->Act(observation);
    EXPECT_EQ(one.position_delta_m, other.position_delta_m);
    EXPECT_EQ(one.world_from_hand_rotation, other.world_from_hand_rotation);
  }
}

TEST(MirroringPolicy, TellsTheBeliefThatTheHandStallsWhereSomethingIsLeftOpen) {
  for (const bool leaves_open : {false, true}) {
    const auto belief =
        Told({.turning = leaves_open ? TurningChoice::kAuto : TurningChoice::kUsual});
    MirroringPolicy policy(std::make_unique<AsksForWhatItSees>(), {Stage::kOpen, false, belief});
    for (int i = 0; i < 4; ++i) policy.Act(Seen());  // the hand stays where it is
    EXPECT_EQ(policy.IsStalled(), leaves_open);
    EXPECT_EQ(belief->GivesUp(), leaves_open);
  }
}

TEST(MirroringPolicy, TellsTheBeliefThatTheLeafComesAlong) {
  const auto belief = Told({.side = SideChoice::kAuto, .opening = OpeningChoice::kAuto});
  belief->Begin(std::nullopt);
  MirroringPolicy policy(std::make_unique<AsksForWhatItSees>(), {Stage::kOpen, false, belief});
  Observation seen = Seen();
  policy.Act(seen);
  const DoorGuess first = policy.guess();
  for (const int i : {25, 26, 27}) seen.proprioception[static_cast<std::size_t>(i)] += 0.1F;
  policy.Act(seen);
  // a door that comes is not pushed; without this the next guess would be that it is
  const DoorGuess next = belief->ForGrasp(HandPositionOf(seen.proprioception));
  EXPECT_EQ(next.opening, first.opening);
  EXPECT_NE(next.side, first.side);
}

TEST(MirroringPolicy, APolicyOfTheArmsJointsHasNoMirrorImage) {
  const StageNetworks networks = SomeNetworks(StateKind::kJoints);
  EXPECT_NO_THROW(MakePolicy(networks, {}));
  PolicyOptions right;
  right.told.side = SideChoice::kRight;
  EXPECT_THROW(MakePolicy(networks, right), Error);
  PolicyOptions reversed;
  reversed.told.turning = TurningChoice::kReversed;
  EXPECT_THROW(MakePolicy(networks, reversed), Error);
}

// What a policy asks for first where it is told that the door is pushed.
Action Pushing(MotionNetworks learned) {
  PolicyOptions options;
  options.told.opening = OpeningChoice::kPush;
  Observation observation;
  const auto made = testing::MakeSyntheticSamples(5, 4);
  observation.proprioception = made.samples.front().proprioception;
  observation.cloud.xyz.assign(made.samples.front().cloud.begin(),
                               made.samples.front().cloud.end());
  return MakePolicy(std::move(learned), options)->Act(observation);
}

TEST(MirroringPolicy, PushesByTheNetworksThatHaveLearnedIt) {
  const auto made = testing::MakeSyntheticSamples(5, 4);
  MotionNetworks pulls(SomeNetworks(StateKind::kHand));
  MotionNetworks pushes(InitialNetworks(
      MeasureNormalisation(made.samples, {ViewFrame::kHand, StateKind::kHand}), false, 5));
  MotionNetworks both = pulls;
  both.pushed = pushes.networks;
  EXPECT_TRUE(both.KnowsBothWays());
  EXPECT_FALSE(pulls.KnowsBothWays());
  EXPECT_NE(Pushing(pulls).position_delta_m, Pushing(pushes).position_delta_m);
  EXPECT_EQ(Pushing(both).position_delta_m, Pushing(pushes).position_delta_m);
}

}  // namespace
}  // namespace doorforge
