// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/opening_trial.h"

#include <cmath>

#include <gtest/gtest.h>

#include "primitive_door.h"

namespace doorforge {
namespace {

double ArmOf(const DoorAsset& door) {
  const Eigen::Vector3d grasp =
      door.handle_joint.parent_from_child_at_zero * door.handle_from_grasp.translation();
  return grasp.cross(door.hinge.axis).norm();
}

TEST(OpeningTrial, OpensALeverDoorAsItIsMeantTo) {
  const DoorAsset door = MakePrimitiveDoor({});
  const OpeningTrial trial = TryOpening(door);
  EXPECT_TRUE(trial.finite);
  EXPECT_TRUE(trial.latched);
  EXPECT_TRUE(trial.held);
  EXPECT_LT(std::abs(trial.given_rad), 1e-3);
  EXPECT_TRUE(trial.unlocked);
  EXPECT_GE(trial.turned_rad, door.latch.handle_done_angle_rad);
  EXPECT_LT(std::abs(trial.returned_rad), 1e-3);
  EXPECT_GT(trial.opened_rad, 0.785);
  EXPECT_LT(trial.opened_s, 3);
}

// A force that grows as P t / 1 s turns a free leaf by P a t^3 / (6 I).
TEST(OpeningTrial, TakesTheTimeThatTheLawOfMotionGives) {
  DoorAsset door = MakePrimitiveDoor({.mechanism = Mechanism::kNone});
  door.latch.type = LatchType::kNone;
  door.latch.hinge_spring_nm_per_rad = 0;
  door.hinge.damping_nm_s = 0;
  OpeningTrialConfig config;
  const double arm = ArmOf(door);
  const double inertia = InertiaAboutHinge(door);
  const double expected = std::cbrt(6 * inertia * config.open_rad / (config.pull_n * arm));
  ASSERT_LT(expected, 1);
  const OpeningTrial trial = TryOpening(door, config);
  EXPECT_FALSE(trial.latched);
  EXPECT_NEAR(trial.opened_s, expected, 3 * config.time_step_s);
}

TEST(OpeningTrial, FindsTheEffortThatHoldsTheOverload) {
  DoorAsset door = MakePrimitiveDoor({});
  const OpeningTrialConfig config;
  const double needed = config.overload * config.pull_n * ArmOf(door);
  door.latch.lock_effort_nm = 1.05 * needed;
  EXPECT_TRUE(TryOpening(door).held);
  door.latch.lock_effort_nm = 0.95 * needed;
  const OpeningTrial trial = TryOpening(door);
  EXPECT_FALSE(trial.held);
  EXPECT_GT(trial.given_rad, 0.01);
}

// The spring and the nominal turn meet at torque / spring.
TEST(OpeningTrial, TurnsAStiffHandleAsFarAsItsSpringAllows) {
  DoorAsset door = MakePrimitiveDoor({});
  door.latch.handle_spring_nm_per_rad = 20;
  const OpeningTrialConfig config;
  const OpeningTrial trial = TryOpening(door, config);
  EXPECT_FALSE(trial.unlocked);
  EXPECT_NEAR(trial.turned_rad, config.handle_torque_nm / 20, 0.03);
  EXPECT_LT(trial.opened_rad, 0.01);
}

TEST(OpeningTrial, IsTheSameBitByBit) {
  const DoorAsset door = MakePrimitiveDoor({.mechanism = Mechanism::kRound});
  const OpeningTrial a = TryOpening(door);
  const OpeningTrial b = TryOpening(door);
  EXPECT_EQ(a.given_rad, b.given_rad);
  EXPECT_EQ(a.turned_rad, b.turned_rad);
  EXPECT_EQ(a.returned_rad, b.returned_rad);
  EXPECT_EQ(a.opened_rad, b.opened_rad);
  EXPECT_EQ(a.opened_s, b.opened_s);
}

}  // namespace
}  // namespace doorforge
