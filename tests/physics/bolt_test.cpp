// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/bolt.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/opening_trial.h"
#include "doorforge/physics/robotless_door.h"

#include "primitive_door.h"

namespace doorforge {
namespace {

constexpr double kBoltTimeStep = 1.0 / 240;

DoorAsset Bolted(DoorAsset door, double throw_m = 0.012) {
  door.latch.type = LatchType::kBolt;
  door.latch.bolt_throw_m = throw_m;
  return door;
}

// Turns the handle until it is `angle` and holds it there by a stiff, damped hand.
void HoldHandle(RobotlessDoor& door, double angle, double seconds, double hinge_nm = 0) {
  for (double time = 0; time < seconds; time += kBoltTimeStep)
    door.Step(hinge_nm, 40 * (angle - door.handle_rad()) - 0.15 * door.handle_rad_s());
}

TEST(Bolt, ReachesIntoTheStrikeByItsThrowAndIsClearOfItAtTheUnlockAngle) {
  for (const double throw_m : {0.002, 0.012, 0.03}) {
    const DoorAsset door = Bolted(MakePrimitiveDoor({}), throw_m);
    const Bolt bolt = BoltOf(door);
    EXPECT_DOUBLE_EQ(bolt.travel_m_per_rad * door.latch.unlock_angle_rad, throw_m);
    EXPECT_TRUE(IsCaught(bolt, door, 0, 0));
    EXPECT_TRUE(IsCaught(bolt, door, 0, -0.95 * throw_m));
    EXPECT_FALSE(IsCaught(bolt, door, 0, -throw_m));
    EXPECT_FALSE(IsCaught(bolt, door, 0.1, 0));  // beyond the strike
    EXPECT_GE(bolt.travel_m, throw_m);
  }
}

TEST(Bolt, NeedsAHandleThatTurnsAndAThrow) {
  EXPECT_THROW(BoltOf(MakePrimitiveDoor({.mechanism = Mechanism::kNone})), Error);
  DoorAsset door = Bolted(MakePrimitiveDoor({}), 0);
  EXPECT_THROW(BoltOf(door), Error);
  EXPECT_THROW(RobotlessDoor{door}, Error);
}

// throw * min(1, handle / unlock), within a twentieth of a millimetre
TEST(Bolt, IsDrawnBackInProportionToTheHandleAndNoFurtherThanItsThrow) {
  const DoorAsset door = Bolted(MakePrimitiveDoor({}));
  RobotlessDoor lone(door);
  const double unlock = door.latch.unlock_angle_rad;
  for (const double angle : {0.25 * unlock, 0.5 * unlock, 0.9 * unlock, 1.3 * unlock}) {
    HoldHandle(lone, angle, 1);
    ASSERT_GT(lone.handle_rad(), 0.8 * angle);
    const double wanted = door.latch.bolt_throw_m * std::min(1.0, lone.handle_rad() / unlock);
    EXPECT_NEAR(-lone.bolt_m(), wanted, 5e-5) << lone.handle_rad() / unlock;
  }
  for (int i = 0; i < 480; ++i) lone.Step(0, 0);
  EXPECT_NEAR(lone.bolt_m(), 0, 5e-5);
  EXPECT_NEAR(lone.handle_rad(), 0, 1e-3);
}

// At rest the hand bears the handle's spring and, through the cable, that of the bolt.
TEST(Bolt, ItsSpringIsFeltAtTheHandle) {
  const DoorAsset door = Bolted(MakePrimitiveDoor({}));
  const Bolt bolt = BoltOf(door);
  RobotlessDoor lone(door);
  const double torque = 0.8;
  for (int i = 0; i < 2400; ++i) lone.Step(0, torque * std::min(1.0, i / 480.0));
  const double drawn = bolt.travel_m_per_rad * lone.handle_rad();
  const double expected = door.latch.handle_spring_nm_per_rad * lone.handle_rad() +
                          bolt.travel_m_per_rad * (bolt.preload_n + bolt.stiffness_n_per_m * drawn);
  EXPECT_LT(lone.handle_rad(), door.latch.unlock_angle_rad);
  EXPECT_NEAR(torque, expected, 0.01 * torque);
}

TEST(Bolt, HoldsWhateverTheEffortUntilTheHandleHasDrawnItBack) {
  const DoorAsset door = Bolted(MakePrimitiveDoor({}));
  RobotlessDoor lone(door);
  for (int i = 0; i < 480; ++i) {
    lone.Step(400, 0);
    ASSERT_LT(lone.hinge_rad(), 0.004);
  }
  EXPECT_TRUE(lone.latch().locked);
  RobotlessDoor other(door);
  HoldHandle(other, 1.2 * door.latch.unlock_angle_rad, 0.5);
  EXPECT_FALSE(other.latch().locked);
  HoldHandle(other, 1.2 * door.latch.unlock_angle_rad, 0.5, 20);
  EXPECT_GT(other.hinge_rad(), 0.1);
}

// Pushed shut with the handle at rest, the bevel drives the bolt in and it springs out behind the
// strike.
void ExpectCatchesAgain(const DoorAsset& door, double closing_nm) {
  RobotlessDoor lone(door);
  const double turned = std::min(1.2 * door.latch.unlock_angle_rad, door.handle_joint.upper_rad);
  HoldHandle(lone, turned, 0.5);
  for (int i = 0; i < 960 && lone.hinge_rad() < 0.3; ++i)
    lone.Step(15, 40 * (turned - lone.handle_rad()) - 0.15 * lone.handle_rad_s());
  ASSERT_GT(lone.hinge_rad(), 0.25);
  EXPECT_FALSE(lone.latch().locked);
  double deepest = 0;
  for (int i = 0; i < 1200; ++i) {
    lone.Step(-closing_nm, 0);
    deepest = std::min(deepest, lone.bolt_m());
  }
  EXPECT_LT(deepest, -0.5 * door.latch.bolt_throw_m);  // it has been pushed in
  EXPECT_TRUE(lone.latch().locked);
  EXPECT_LT(lone.hinge_rad(), 0.004);
  EXPECT_NEAR(lone.bolt_m(), 0, 1e-4);
  for (int i = 0; i < 480; ++i) lone.Step(80, 0);
  EXPECT_LT(lone.hinge_rad(), 0.005);
}

TEST(Bolt, CatchesAgainAsTheDoorCloses) {
  for (const double throw_m : {0.004, 0.012, 0.025}) {
    SCOPED_TRACE(throw_m);
    ExpectCatchesAgain(Bolted(MakePrimitiveDoor({}), throw_m), 12);
  }
  ExpectCatchesAgain(Bolted(MakePrimitiveDoor({.width_m = 0.4, .leaf_mass_kg = 4})), 8);
}

TEST(Bolt, WorksOnDoorsOfEverySideAndOpening) {
  for (const HingeSide side : {HingeSide::kLeft, HingeSide::kRight}) {
    for (const Opening opening : {Opening::kPull, Opening::kPush}) {
      SCOPED_TRACE(std::string(NameOf(side)) + " " + std::string(NameOf(opening)));
      const DoorAsset door = Bolted(MakePrimitiveDoor({.hinge_side = side, .opening = opening}));
      ExpectCatchesAgain(door, 12);
      const OpeningTrial trial = TryOpening(door);
      EXPECT_TRUE(trial.held && trial.unlocked) << trial.given_rad;
      EXPECT_GT(trial.opened_rad, 0.785);
      EXPECT_LT(trial.returned_rad, 0.01);
    }
  }
}

TEST(Bolt, IsTheSameBitByBit) {
  const DoorAsset door = Bolted(MakePrimitiveDoor({.mechanism = Mechanism::kRound}));
  const OpeningTrial a = TryOpening(door);
  const OpeningTrial b = TryOpening(door);
  EXPECT_EQ(std::tie(a.given_rad, a.turned_rad, a.returned_rad, a.opened_rad, a.opened_s),
            std::tie(b.given_rad, b.turned_rad, b.returned_rad, b.opened_rad, b.opened_s));
}

}  // namespace
}  // namespace doorforge
