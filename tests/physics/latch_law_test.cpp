// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/latch_law.h"

#include <gtest/gtest.h>

namespace doorforge {
namespace {

Latch PaperLatch() {
  Latch latch;
  latch.type = LatchType::kEffort;
  latch.unlock_angle_rad = 0.5;
  latch.handle_done_angle_rad = 0.6;
  return latch;
}

TEST(LatchLaw, HoldsWith150NewtonMetresUntilTheHandlePassesItsThreshold) {
  const Latch latch = PaperLatch();
  LatchState state = UpdatedLatch(latch, {}, 0, 0);
  EXPECT_TRUE(state.locked);
  EXPECT_EQ(TorquesOf(latch, state, 0.001, 0.4).hinge_nm, -150);
  EXPECT_EQ(TorquesOf(latch, state, 0.001, 0.4).handle_nm, -3 * 0.4);
  state = UpdatedLatch(latch, state, 0.001, 0.5);
  EXPECT_TRUE(state.locked);  // the paper's law locks up to and including the threshold
  state = UpdatedLatch(latch, state, 0.001, 0.501);
  EXPECT_FALSE(state.locked);
  EXPECT_EQ(TorquesOf(latch, state, 0.7, 0.4).hinge_nm, -3 * 0.7);
}

TEST(LatchLaw, AnAjarDoorStaysUnlockedUnlessTheLatchCatchesAgain) {
  Latch latch = PaperLatch();
  LatchState state = UpdatedLatch(latch, {}, 0, 0.55);
  state = UpdatedLatch(latch, state, 0.02, 0.55);
  EXPECT_FALSE(UpdatedLatch(latch, state, 0.02, 0).locked);
  EXPECT_TRUE(UpdatedLatch(latch, state, 0.005, 0).locked);
  latch.relatch = true;
  EXPECT_TRUE(UpdatedLatch(latch, state, 0.02, 0).locked);
}

TEST(LatchLaw, LeakingPastTheAjarAngleUnderLoadDoesNotUnlock) {
  const Latch latch = PaperLatch();
  const LatchState locked = UpdatedLatch(latch, {}, 0, 0);
  EXPECT_TRUE(UpdatedLatch(latch, locked, 0.02, 0).locked);
}

TEST(LatchLaw, InTheReleasedVariantAnAjarDoorIsUnlockedHoweverItGotThere) {
  Latch latch = PaperLatch();
  latch.unlocks_ajar = true;
  LatchState state = UpdatedLatch(latch, {}, 0, 0);
  EXPECT_TRUE(state.locked);
  state = UpdatedLatch(latch, state, 0.0099, 0);
  EXPECT_TRUE(state.locked);
  state = UpdatedLatch(latch, state, 0.0101, 0);
  EXPECT_FALSE(state.locked);
  EXPECT_EQ(TorquesOf(latch, state, 0.0101, 0).hinge_nm, -3 * 0.0101);
  EXPECT_TRUE(UpdatedLatch(latch, state, 0.005, 0).locked);  // shut again
}

TEST(LatchLaw, ABoltHoldsByContactAndNotByTorque) {
  Latch latch = PaperLatch();
  latch.type = LatchType::kBolt;
  LatchState caught;
  caught.locked = true;
  EXPECT_EQ(TorquesOf(latch, caught, 0.002, 0).hinge_nm, -3 * 0.002);
  EXPECT_TRUE(UpdatedLatch(latch, caught, 0.002, 0.6).locked);  // the bolt's place decides
  EXPECT_TRUE(UpdatedLatch(latch, caught, 0.002, 0.6).handle_done);
}

TEST(LatchLaw, HandleDoneIsASecondThresholdAndSticky) {
  const Latch latch = PaperLatch();
  LatchState state = UpdatedLatch(latch, {}, 0, 0.55);
  EXPECT_FALSE(state.handle_done);
  state = UpdatedLatch(latch, state, 0, 0.6);
  EXPECT_TRUE(state.handle_done);
  EXPECT_TRUE(UpdatedLatch(latch, state, 0, 0).handle_done);
}

TEST(LatchLaw, WithoutALatchNothingLocks) {
  const LatchState state = UpdatedLatch(Latch{}, {}, 0, 0);
  EXPECT_FALSE(state.locked);
  EXPECT_TRUE(state.handle_done);
}

}  // namespace
}  // namespace doorforge
