// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/policy/door_belief.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/core/rng.h"
#include "doorforge/policy/belief_grasp.h"

namespace doorforge {
namespace {

constexpr ToldOfDoor kNothing{SideChoice::kAuto, TurningChoice::kAuto, OpeningChoice::kAuto};
constexpr DoorGuess kLeftPulled{};
const Eigen::Vector3f kHand(0, 0, 1);

// Says left where the number is positive.
SideClassifier BySignOfTheFirst() {
  SideClassifier classifier;
  classifier.weight.fill(0);
  classifier.weight.front() = 8;
  return classifier;
}

LabelledCloud DoorOnTheSideOf(float y) { return {{0, y, 1, 0, y, 1.01F}, {0, 0}}; }

// The guesses of grasps that all fail: each handle turns without a stall, and no door opens.
std::vector<DoorGuess> GuessesOf(DoorBelief& belief, int grasps) {
  std::vector<DoorGuess> guesses;
  for (int i = 0; i < grasps; ++i) {
    guesses.push_back(belief.ForStage(Stage::kHandle, kHand));
    EXPECT_EQ(belief.ForStage(Stage::kOpen, kHand), guesses.back());  // one guess a grasp
  }
  return guesses;
}

TEST(DoorBelief, WhatIsToldIsNeverDoubted) {
  for (const SideChoice side : {SideChoice::kLeft, SideChoice::kRight}) {
    for (const OpeningChoice opening : {OpeningChoice::kPull, OpeningChoice::kPush}) {
      DoorBelief belief({side, TurningChoice::kReversed, opening}, {});
      EXPECT_FALSE(belief.LeavesOpen());
      belief.Begin(std::nullopt);
      const DoorGuess told{side == SideChoice::kLeft ? HingeSide::kLeft : HingeSide::kRight,
                           MotionWay::kOther,
                           opening == OpeningChoice::kPull ? MotionWay::kUsual : MotionWay::kOther};
      EXPECT_EQ(GuessesOf(belief, 5), std::vector(5, told));
    }
  }
}

TEST(DoorBelief, BeginsOnTheSideThatThePictureShows) {
  DoorBelief belief(kNothing, {.side = BySignOfTheFirst()});
  EXPECT_TRUE(belief.WantsPicture());
  belief.Begin(DoorOnTheSideOf(0.1F));
  EXPECT_EQ(belief.ForStage(Stage::kHandle, kHand).side, HingeSide::kLeft);
  belief.Begin(DoorOnTheSideOf(-0.1F));
  EXPECT_EQ(belief.ForStage(Stage::kHandle, kHand).side, HingeSide::kRight);
  belief.Begin(std::nullopt);
  EXPECT_EQ(belief.ForStage(Stage::kHandle, kHand), kLeftPulled);
  EXPECT_FALSE(DoorBelief({}, {.side = BySignOfTheFirst()}).WantsPicture());
}

TEST(DoorBelief, TriesEveryKindOfDoorThatIsLeftOpen) {
  DoorBelief belief(kNothing, {});
  belief.Begin(std::nullopt);
  // the common kinds again before the rarest of all for the first time
  const std::vector<DoorGuess> guesses = GuessesOf(belief, 16);
  std::vector<DoorGuess> kinds;
  for (const DoorGuess& guess : guesses)
    if (std::count(kinds.begin(), kinds.end(), guess) == 0) kinds.push_back(guess);
  EXPECT_EQ(kinds.size(), 8U);
}

TEST(DoorBelief, APictureThatIsClearKeepsTheSideAndTriesTheRest) {
  DoorBelief belief(kNothing, {.side = BySignOfTheFirst()});
  belief.Begin(DoorOnTheSideOf(-0.1F));
  const std::vector<DoorGuess> guesses = GuessesOf(belief, 4);
  for (const DoorGuess& guess : guesses) EXPECT_EQ(guess.side, HingeSide::kRight);
  EXPECT_EQ(guesses[1].opening, MotionWay::kOther);  // the handle seemed to turn: it is pushed
  EXPECT_EQ(guesses[1].turning, MotionWay::kUsual);
  EXPECT_EQ(guesses[2].opening, MotionWay::kUsual);  // or the first grasp failed by itself
  EXPECT_EQ(guesses[3].turning, MotionWay::kOther);
}

TEST(DoorBelief, AHandleThatStallsIsTurnedTheOtherWayNext) {
  DoorBelief belief({SideChoice::kLeft, TurningChoice::kAuto, OpeningChoice::kAuto}, {});
  belief.Begin(std::nullopt);
  belief.ForStage(Stage::kHandle, kHand);
  belief.NoteStall(Stage::kHandle);
  EXPECT_FALSE(belief.GivesUp());  // there may be no latch
  EXPECT_EQ(belief.ForStage(Stage::kOpen, kHand), kLeftPulled);
  belief.NoteStall(Stage::kOpen);
  EXPECT_TRUE(belief.GivesUp());
  const DoorGuess next = belief.ForStage(Stage::kHandle, kHand);
  EXPECT_FALSE(belief.GivesUp());
  EXPECT_EQ(next, (DoorGuess{HingeSide::kLeft, MotionWay::kOther, MotionWay::kUsual}));
}

// The leaf came some way with the hand: no latch holds it, and it is not pushed.
TEST(DoorBelief, ALeafThatCameAlongIsNotPushedButTurnedTheOtherWayOrHingedElsewhere) {
  DoorBelief belief(kNothing, {.side = BySignOfTheFirst()});
  for (const float y : {0.1F, 0.002F}) {
    belief.Begin(DoorOnTheSideOf(y));
    belief.ForStage(Stage::kHandle, kHand);
    belief.ForStage(Stage::kOpen, kHand);
    belief.NoteLeafFollows();
    const bool picture_is_clear = y > 0.01F;
    const DoorGuess next = belief.ForStage(Stage::kHandle, kHand);
    EXPECT_EQ(next, picture_is_clear
                        ? (DoorGuess{HingeSide::kLeft, MotionWay::kOther, MotionWay::kUsual})
                        : (DoorGuess{HingeSide::kRight, MotionWay::kUsual, MotionWay::kUsual}));
  }
}

TEST(DoorBelief, WhatIsNothingLikeThePushedDoorsOfTheTrainingIsPulledAsLongAsAnythingElseIsLeft) {
  const DoorKnowledge knowledge{.pushed = LearnedHeights{1.9, 2.3}};
  DoorBelief belief(kNothing, knowledge);
  EXPECT_TRUE(belief.WantsPicture());
  EXPECT_FALSE(DoorBelief({}, knowledge).WantsPicture());
  const auto begin_with = [&](float height) {
    belief.Begin(LabelledCloud{{0, 0, 0, 0, 0, height}, {0, 0}});
    return GuessesOf(belief, 4);
  };
  for (const DoorGuess& guess : begin_with(0.8F)) EXPECT_EQ(guess.opening, MotionWay::kUsual);
  const std::vector<DoorGuess> tall = begin_with(2.1F);
  EXPECT_TRUE(std::ranges::any_of(
      tall, [](const DoorGuess& guess) { return guess.opening == MotionWay::kOther; }));
}

TEST(DoorBelief, AGraspThatReachedNoStageSaysNothing) {
  DoorBelief belief(kNothing, {});
  belief.Begin(std::nullopt);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(belief.ForGrasp(kHand), kLeftPulled);
}

// Takes hold at the first place that is not tried yet.
class NextPlace : public GraspPolicy {
 public:
  std::optional<GraspAction> Choose(const GraspObservation& observation) override {
    GraspAction action;
    action.contact_m.z() = static_cast<double>(observation.tried.size());
    action.world_from_hand_rotation << 0, 0, -1, -1, 0, 0, 0, 1, 0;  // z into the leaf, y up
    return action;
  }
};

class BeliefGraspTest : public ::testing::Test {
 protected:
  // Plays a grasp that led nowhere.
  GraspAction Fail() {
    const GraspAction action = *grasps_.Choose(seen_);
    seen_.tried.push_back({action.contact_m, action.world_from_hand_rotation});
    belief_->ForStage(Stage::kHandle, kHand);
    belief_->ForStage(Stage::kOpen, kHand);
    return action;
  }

  std::shared_ptr<DoorBelief> belief_ = std::make_shared<DoorBelief>(
      ToldOfDoor{SideChoice::kLeft, TurningChoice::kUsual, OpeningChoice::kAuto}, DoorKnowledge{});
  BeliefGrasp grasps_{std::make_unique<NextPlace>(), belief_};
  GraspObservation seen_;
};

TEST_F(BeliefGraspTest, APlaceThatWasTriedByAnotherGuessIsTriedAgain) {
  belief_->Begin(std::nullopt);
  EXPECT_EQ(Fail().contact_m.z(), 0);  // pulled
  EXPECT_EQ(Fail().contact_m.z(), 0);  // pushed
  EXPECT_EQ(Fail().contact_m.z(), 1);  // pulled, once more
}

TEST_F(BeliefGraspTest, WhoPushesLeansTowardsTheHinge) {
  belief_->Begin(std::nullopt);
  const Eigen::Vector3d pulls = Fail().world_from_hand_rotation.col(2);
  const Eigen::Vector3d pushes = Fail().world_from_hand_rotation.col(2);
  EXPECT_NEAR(std::acos(pulls.dot(pushes)), 0.35, 1e-9);
  EXPECT_GT(pushes.y(), 0.3);  // the fingers point away from the hinge, which is at lesser y
  EXPECT_NEAR(pushes.z(), 0, 1e-9);
}

TEST(ClearOfTheJamb, IsForEitherSideTheMirrorImageOfTheOther) {
  Rng rng(1, "test/jamb");
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1, -1, 1).asDiagonal();
  for (int i = 0; i < 20; ++i) {
    const Eigen::Matrix3d hand =
        Eigen::Quaterniond(rng.Normal(), rng.Normal(), rng.Normal(), rng.Normal())
            .normalized()
            .toRotationMatrix();
    Eigen::Matrix3d mirrored = mirror * hand;
    mirrored.col(1) *= -1;
    const Eigen::Vector3d left = ClearOfTheJamb(hand, HingeSide::kLeft).col(2);
    const Eigen::Vector3d right = ClearOfTheJamb(mirrored, HingeSide::kRight).col(2);
    EXPECT_LT((mirror * left - right).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace doorforge
