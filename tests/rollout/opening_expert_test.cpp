// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/opening_expert.h"

#include <numbers>

#include <gtest/gtest.h>

#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/door_facts.h"

namespace doorforge {
namespace {

// A hinge along -z at the origin, a hand 0.5 m along y, a handle that does not turn.
Observation ObservedDoor(double hinge_rad) {
  Observation observation;
  PrivilegedState& state = observation.privileged;
  state.hinge_rad = hinge_rad;
  state.hinge_axis_in_world = {0, 0, -1};
  const RigidTransform turn = RotationAbout({0, 0, -1}, hinge_rad);
  state.world_from_handle = turn * Translation({0, 0.5, 0.9});
  state.world_from_hand = state.world_from_handle;
  state.handle_origin_in_world = state.world_from_handle.translation();
  state.handle_axis_in_world = turn.linear() * Eigen::Vector3d::UnitX();
  return observation;
}

TEST(OpeningExpert, LeadsTheHandAlongTheArcByAtMostItsStep) {
  OpeningExpertConfig config;
  config.press_rad = 0;
  OpeningExpert expert(config);
  expert.Reset();
  double last = 0;
  for (int i = 0; i < 6; ++i) {
    const Observation observation = ObservedDoor(0.1 * i);
    const Action action = expert.Act(observation);
    const Eigen::Vector3d target =
        observation.privileged.world_from_hand.translation() + action.position_delta_m;
    EXPECT_NEAR(target.head<2>().norm(), 0.5, 1e-9);  // stays on the circle
    const double angle = std::atan2(target.x(), target.y());
    EXPECT_GT(angle, 0.1 * i);
    const double arc = 0.5 * (angle - 0.1 * i);
    EXPECT_LE(arc, config.step_m + 1e-9);
    EXPECT_GE(arc, last - 1e-9);
    last = arc;
    // the hand turns with the door
    const Eigen::Matrix3d expected = RotationAbout({0, 0, -1}, angle).linear();
    EXPECT_TRUE(action.world_from_hand_rotation.isApprox(expected, 1e-9));
  }
  EXPECT_NEAR(last, config.step_m, 1e-9);
}

TEST(OpeningExpert, PressesTheHandleUntilTheDoorIsAjarThenLetsItGo) {
  OpeningExpert expert;
  expert.Reset();
  const auto press_of = [&](double hinge) {
    const Observation observation = ObservedDoor(hinge);
    const Action action = expert.Act(observation);
    // turn about the handle's axis that is left after the hinge's
    const Eigen::Vector3d up = action.world_from_hand_rotation.col(2);
    return std::acos(std::clamp(up.z(), -1.0, 1.0));
  };
  EXPECT_NEAR(press_of(0), 0.25, 1e-6);
  EXPECT_NEAR(press_of(0.05), 0.25, 1e-6);
  EXPECT_NEAR(press_of(0.1), 0.25 - 0.133, 1e-6);
  press_of(0.2);
  EXPECT_NEAR(press_of(0.3), 0, 1e-6);
}

TEST(OpeningExpert, DoesNotLetAHandleBackThatWouldLockTheOpenDoor) {
  OpeningExpert expert;
  expert.Reset();
  for (const double hinge_rad : {0.0, 0.1, 0.3, 0.7}) {
    Observation observation = ObservedDoor(hinge_rad);
    observation.privileged.door.relatches = true;
    const Eigen::Vector3d up = expert.Act(observation).world_from_hand_rotation.col(2);
    EXPECT_NEAR(std::acos(std::clamp(up.z(), -1.0, 1.0)), 0.25, 1e-6) << hinge_rad;
  }
}

TEST(DoorFacts, SayWhetherTheLatchLocksAnOpenDoor) {
  DoorAsset door;
  door.latch.type = LatchType::kEffort;
  EXPECT_FALSE(FactsOf(door).relatches);
  door.latch.relatch = true;
  EXPECT_TRUE(FactsOf(door).relatches);
  door.latch.type = LatchType::kBolt;  // catches as the leaf closes, and not before
  EXPECT_FALSE(FactsOf(door).relatches);
}

}  // namespace
}  // namespace doorforge
