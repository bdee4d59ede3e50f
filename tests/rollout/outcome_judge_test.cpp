// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/outcome_judge.h"

#include <gtest/gtest.h>

namespace doorforge {
namespace {

const EpisodeLimits kLimits;

Hindrance Behind(double arm_force_n, double self_force_n = 0, std::string joint = {}) {
  Hindrance hindrance;
  hindrance.behind_m = 0.02;
  hindrance.contacts.arm_force_n = arm_force_n;
  hindrance.contacts.arm_touches = "link5-leaf";
  hindrance.contacts.self_force_n = self_force_n;
  hindrance.contacts.self_touches = "link2-hand";
  hindrance.joint_at_limit = std::move(joint);
  return hindrance;
}

TEST(HeldUpBy, NamesTheDoorThenTheRobotThenAJoint) {
  const auto door = HeldUpBy(Behind(51, 51, "joint4"), kLimits);
  EXPECT_EQ(door->outcome, EpisodeOutcome::kCollision);
  EXPECT_EQ(door->detail, ", blocked at link5-leaf");
  const auto itself = HeldUpBy(Behind(50, 51, "joint4"), kLimits);
  EXPECT_EQ(itself->outcome, EpisodeOutcome::kCollision);
  EXPECT_EQ(itself->detail, ", blocked by itself at link2-hand");
  const auto joint = HeldUpBy(Behind(50, 50, "joint4"), kLimits);
  EXPECT_EQ(joint->outcome, EpisodeOutcome::kJointLimit);
  EXPECT_EQ(joint->detail, ", joint4 at its limit");
  EXPECT_FALSE(HeldUpBy(Behind(50), kLimits));
}

TEST(HeldUpBy, IsNothingWhereTheHandFollows) {
  Hindrance follows = Behind(1000, 1000, "joint4");
  follows.behind_m = 0.0099;
  EXPECT_FALSE(HeldUpBy(follows, kLimits));
  EpisodeLimits strict;
  strict.hand_behind_m = 0.005;
  EXPECT_TRUE(HeldUpBy(follows, strict));
  strict.blocking_force_n = 2000;
  EXPECT_EQ(HeldUpBy(follows, strict)->outcome, EpisodeOutcome::kJointLimit);
}

TEST(JointAtLimit, TakesTheMarginOfItsKindOfJoint) {
  const RobotModel robot = LoadMobileFranka();
  JointVector position = robot.InitialPosition();
  EXPECT_EQ(JointAtLimit(robot, position, kLimits), "");
  const int turns = robot.base_count() + 3;
  position[turns] = robot.joint(turns).upper - 0.009;
  EXPECT_EQ(JointAtLimit(robot, position, kLimits), robot.joint(turns).name);
  position[turns] = robot.joint(turns).upper - 0.011;
  EXPECT_EQ(JointAtLimit(robot, position, kLimits), "");
  position[0] = robot.joint(0).lower + 0.002;
  EXPECT_EQ(JointAtLimit(robot, position, kLimits), robot.joint(0).name);
  position[0] = robot.joint(0).lower + 0.004;
  EXPECT_EQ(JointAtLimit(robot, position, kLimits), "");
  EpisodeLimits wide;
  wide.joint_margin_m = 0.005;
  EXPECT_EQ(JointAtLimit(robot, position, wide), robot.joint(0).name);
}

TEST(JudgeReach, IsNotReachedUnlessSomethingHoldsTheHandUp) {
  const Verdict free = JudgeReach(0.2, Behind(0), kLimits);
  EXPECT_EQ(free.outcome, EpisodeOutcome::kNotReached);
  EXPECT_EQ(free.detail, "hand 200 mm from the grasp pose");
  const Verdict blocked = JudgeReach(0.2, Behind(80), kLimits);
  EXPECT_EQ(blocked.outcome, EpisodeOutcome::kCollision);
  EXPECT_EQ(blocked.detail, "hand 200 mm from the grasp pose, blocked at link5-leaf");
}

TEST(JudgeClosing, SaysWhatThePadsTouch) {
  DoorContacts contacts;
  contacts.pad_points = {0, 3};
  const Verdict missed = JudgeClosing(contacts, 0.0123);
  EXPECT_EQ(missed.outcome, EpisodeOutcome::kGraspMissed);
  EXPECT_EQ(missed.detail, "pads touch with 0 and 3 points, fingers at 12.3 mm");
}

TEST(IsTurned, NeedsTheAngleAndAFreeLeaf) {
  Latch latch;
  latch.type = LatchType::kEffort;
  latch.handle_done_angle_rad = 0.6;
  WorldState state;
  state.handle_done = true;  // once, which is not now
  state.handle_rad = 0.59;
  EXPECT_FALSE(IsTurned(latch, state));
  state.handle_rad = 0.6;
  EXPECT_TRUE(IsTurned(latch, state));
  state.locked = true;
  EXPECT_FALSE(IsTurned(latch, state));
  latch.type = LatchType::kNone;
  EXPECT_TRUE(IsTurned(latch, state));
}

TEST(JudgeTurn, IsSlippedOnlyBeyondTheLimits) {
  TurnEvidence evidence;
  evidence.handle_rad = 0.2;
  evidence.done_rad = 0.6;
  evidence.slip_m = 0.025;
  evidence.slip_rad = 0.125;
  EXPECT_EQ(JudgeTurn(evidence, kLimits).outcome, EpisodeOutcome::kHandleStuck);
  EXPECT_EQ(JudgeTurn(evidence, kLimits).detail,
            "handle at 11.5 of 34.4 deg, grasp moved 25 mm and turned 7 deg in it");
  evidence.hindrance = Behind(80);
  EXPECT_EQ(JudgeTurn(evidence, kLimits).outcome, EpisodeOutcome::kCollision);
  evidence.slip_m = 0.026;
  EXPECT_EQ(JudgeTurn(evidence, kLimits).outcome, EpisodeOutcome::kHandleSlipped);
  evidence.slip_m = 0;
  evidence.slip_rad = 0.126;
  EXPECT_EQ(JudgeTurn(evidence, kLimits).outcome, EpisodeOutcome::kHandleSlipped);
  evidence.slip_rad = 0;
  evidence.lost_pads = true;
  EXPECT_EQ(JudgeTurn(evidence, kLimits).outcome, EpisodeOutcome::kHandleSlipped);
}

OpeningEvidence Stuck() {
  OpeningEvidence evidence;
  evidence.hinge_rad = 0.5;
  evidence.actions = 25;
  evidence.slip_m = 0.004;
  return evidence;
}

TEST(JudgeOpening, IsStuckWhereTheGraspHeldAndLostWhereItDidNot) {
  OpeningEvidence evidence = Stuck();
  EXPECT_EQ(JudgeOpening(evidence, kLimits).outcome, EpisodeOutcome::kDoorStuck);
  EXPECT_EQ(JudgeOpening(evidence, kLimits).detail,
            "hinge at 28.6 deg after 25 actions, last pad contact 0.00 s before the end, grasp "
            "moved 4 mm");
  evidence.hindrance = Behind(80);
  EXPECT_EQ(JudgeOpening(evidence, kLimits).outcome, EpisodeOutcome::kCollision);
  evidence.lost_pads = true;
  EXPECT_EQ(JudgeOpening(evidence, kLimits).outcome, EpisodeOutcome::kGripLost);
  evidence.held_up_at_loss = Verdict{EpisodeOutcome::kJointLimit, ", joint4 at its limit"};
  EXPECT_EQ(JudgeOpening(evidence, kLimits).outcome, EpisodeOutcome::kJointLimit);
  EXPECT_TRUE(JudgeOpening(evidence, kLimits)
                  .detail.ends_with(", arm touches link5-leaf, joint4 at its limit"));
}

TEST(JudgeOpening, ADoorThatCoastsIsLostAndALockedOneWasNotTurned) {
  OpeningEvidence evidence = Stuck();
  evidence.handle_turned = false;
  evidence.early = "the switch came";
  EXPECT_EQ(JudgeOpening(evidence, kLimits).outcome, EpisodeOutcome::kDoorStuck);
  evidence.locked = true;
  EXPECT_EQ(JudgeOpening(evidence, kLimits).outcome, EpisodeOutcome::kHandleStuck);
  EXPECT_TRUE(JudgeOpening(evidence, kLimits).detail.ends_with("; the switch came"));
  evidence.coasted = true;
  EXPECT_EQ(JudgeOpening(evidence, kLimits).outcome, EpisodeOutcome::kGripLost);
  EXPECT_TRUE(
      JudgeOpening(evidence, kLimits).detail.ends_with(", the door coasted past 45 deg by itself"));
}

}  // namespace
}  // namespace doorforge
