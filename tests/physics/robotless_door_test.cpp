// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/robotless_door.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

#include "primitive_door.h"

namespace doorforge {
namespace {

constexpr double kTimeStep = 1.0 / 960;

/// I x'' + c x' + k x = T from rest at 0.
class Oscillator {
 public:
  Oscillator(double inertia, double damping, double spring, double torque)
      : end_(torque / spring), decay_(damping / (2 * inertia)) {
    const double square = spring / inertia - decay_ * decay_;
    overdamped_ = square < 0;
    rate_ = std::sqrt(std::abs(square));
  }

  double At(double time) const {
    const double phase = rate_ * time;
    const double shape = overdamped_ ? std::cosh(phase) + decay_ / rate_ * std::sinh(phase)
                                     : std::cos(phase) + decay_ / rate_ * std::sin(phase);
    return end_ * (1 - std::exp(-decay_ * time) * shape);
  }

 private:
  double end_;
  double decay_;
  double rate_ = 0;
  bool overdamped_ = false;
};

TEST(RobotlessDoor, SwingsAsTheOscillatorThatItsSpringAndDampingMakeIt) {
  for (const double damping : {0.0, 0.5, 40.0}) {
    for (const Opening opening : {Opening::kPull, Opening::kPush}) {
      DoorAsset door = MakePrimitiveDoor({.mechanism = Mechanism::kNone, .opening = opening});
      door.hinge.damping_nm_s = damping;
      door.latch.hinge_spring_nm_per_rad = 6;
      const double torque = 4;  // 0.67 rad at rest, twice that without damping
      const Oscillator exact(InertiaAboutHinge(door), damping, 6, torque);
      RobotlessDoor lone(door, kTimeStep);
      for (int i = 1; i <= 1920; ++i) {
        lone.Step(torque, 0);
        ASSERT_NEAR(lone.hinge_rad(), exact.At(i * kTimeStep), 0.004)
            << damping << " at " << i * kTimeStep << " s";
      }
      EXPECT_GT(lone.hinge_rad(), 0.1);
    }
  }
}

// A hand that lets go: the spring takes the handle back as the oscillator's return, up to the half
// step by which the positions of a stepped simulation run ahead.
TEST(RobotlessDoor, ItsHandleSpringsBackAsAnOscillator) {
  DoorAsset door = MakePrimitiveDoor({});
  door.handle_joint.damping_nm_s = 0.08;
  const double inertia = door.links[kHandleLink].mass.inertia_kg_m2(0, 0) +
                         door.links[kHandleLink].mass.mass_kg *
                             door.links[kHandleLink].mass.center_of_mass_m.tail<2>().squaredNorm();
  const double torque = 1.2;
  const double spring = door.latch.handle_spring_nm_per_rad;
  RobotlessDoor lone(door, kTimeStep);
  for (int i = 0; i < 9600; ++i) lone.Step(0, torque);
  ASSERT_NEAR(lone.handle_rad(), torque / spring, 1e-4);
  const Oscillator exact(inertia, 0.08, spring, torque);
  for (int i = 1; i * kTimeStep < 0.5; ++i) {
    lone.Step(0, 0);
    const double expected = torque / spring - exact.At(i * kTimeStep);
    if (expected < 0.01) break;  // then comes the stop
    const double half_step = std::abs(lone.handle_rad_s()) * kTimeStep / 2;
    ASSERT_NEAR(lone.handle_rad(), expected, half_step + 3e-3) << i * kTimeStep;
  }
  EXPECT_LT(lone.handle_rad(), 0.1);
}

// The lock effort and the pull meet: below it nothing moves, above it the rest accelerates.
TEST(RobotlessDoor, TheEffortLatchHoldsExactlyItsTorque) {
  DoorAsset door = MakePrimitiveDoor({});
  door.hinge.damping_nm_s = 0;
  RobotlessDoor held(door, kTimeStep);
  for (int i = 0; i < 960; ++i) held.Step(door.latch.lock_effort_nm, 0);
  EXPECT_NEAR(held.hinge_rad(), 0, 1e-6);
  RobotlessDoor forced(door, kTimeStep);
  const double over = 5;
  const int steps = 480;
  for (int i = 0; i < steps; ++i) forced.Step(door.latch.lock_effort_nm + over, 0);
  const double time = steps * kTimeStep;
  const double expected = over * time * time / (2 * InertiaAboutHinge(door));
  EXPECT_NEAR(forced.hinge_rad(), expected, 0.01 * expected);
  EXPECT_TRUE(forced.latch().locked);  // however far: force alone does not unlock it
}

TEST(RobotlessDoor, TheReleasedVariantComesFreeAHundredthOfARadianOut) {
  DoorAsset door = MakePrimitiveDoor({});
  door.latch.unlocks_ajar = true;
  RobotlessDoor lone(door, kTimeStep);
  double last_locked = 0;
  for (int i = 0; i < 1920 && lone.hinge_rad() < 0.5; ++i) {
    if (lone.latch().locked) last_locked = lone.hinge_rad();
    lone.Step(door.latch.lock_effort_nm + 5, 0);
  }
  EXPECT_GT(lone.hinge_rad(), 0.5);
  EXPECT_GT(last_locked, 0.009);
  EXPECT_LE(last_locked, 0.01);
}

TEST(RobotlessDoor, RefusesWhatCannotBeSimulatedAndSaysWhy) {
  const auto refusal = [](DoorAsset door) -> std::string {
    try {
      RobotlessDoor lone(door);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  DoorAsset stiff = MakePrimitiveDoor({});
  stiff.hinge.upper_rad = 0;
  EXPECT_NE(refusal(stiff).find("no hinge that opens"), std::string::npos);
  DoorAsset wrong = MakePrimitiveDoor({});
  wrong.opening = Opening::kPush;
  EXPECT_NE(refusal(wrong).find("moves its handle the other way"), std::string::npos);
  DoorAsset torn = MakePrimitiveDoor({});
  torn.latch.relatch = torn.latch.unlocks_ajar = true;
  EXPECT_NE(refusal(torn).find("choose one"), std::string::npos);
  EXPECT_EQ(refusal(MakePrimitiveDoor({})), "");
}

}  // namespace
}  // namespace doorforge
