// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The increments of the baseline against their closed forms, and a door that it opens.

#include <numbers>

#include <gtest/gtest.h>

#include "doorforge/physics/scene_sampling.h"
#include "doorforge/registry/policy_registry.h"
#include "doorforge/registry/policy_set_factory.h"
#include "doorforge/registry/run_policy_set.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::unique_ptr<Policy> Steps(const std::string& name, Stage stage) {
  return BuiltInPolicies().Find(stage, name, "--opener").motion->make({});
}

GraspAction Grasp(const std::string& name, const GraspObservation& seen) {
  return *BuiltInPolicies().Find(Stage::kGrasp, name, "--grasper").grasp->make({})->Choose(seen);
}

// A lever of 14 x 3 cm, 6 cm before the leaf, whose handle's frame is the world's moved to (1, 2,
// 3).
GraspObservation SeenLever() {
  GraspObservation seen;
  seen.privileged.world_from_handle = Translation({1, 2, 3});
  seen.privileged.door.mechanism = Mechanism::kLever;
  seen.privileged.door.handle_box =
      Eigen::AlignedBox3d(Eigen::Vector3d(0, -0.12, -0.01), Eigen::Vector3d(0.06, 0.02, 0.02));
  seen.hand_from_tcp = Translation({0, 0, 0.1034});
  return seen;
}

Eigen::Vector3d ToolOf(const GraspAction& action) {
  return action.contact_m + kGraspInsertion * action.world_from_hand_rotation.col(2);
}

TEST(Gapartnet, TheGraspIsThatOfTheBox) {
  const GraspObservation seen = SeenLever();
  // half the width towards the hinge, as far out as the box is high, less a centimetre
  EXPECT_TRUE(ToolOf(Grasp("gapartnet", seen)).isApprox(Eigen::Vector3d(1.02, 1.93, 3)));
  EXPECT_TRUE(ToolOf(Grasp("gapartnet_clean", seen)).isApprox(Eigen::Vector3d(1.03, 1.95, 3.005)));
  EXPECT_TRUE(ToolOf(Grasp("gapartnet_pull", seen)).isApprox(Eigen::Vector3d(1.0566, 1.95, 3.005)));
  for (const char* name : {"gapartnet_clean", "gapartnet_pull"}) {
    const Eigen::Matrix3d hand = Grasp(name, seen).world_from_hand_rotation;
    EXPECT_TRUE(hand.col(2).isApprox(-Eigen::Vector3d::UnitX())) << name;
    EXPECT_TRUE(hand.col(1).isApprox(Eigen::Vector3d::UnitZ())) << name;  // across the bar
    EXPECT_NEAR(hand.determinant(), 1, 1e-12);
  }
}

TEST(Gapartnet, TheReleasedGraspIsRolledByTenDegreesAtMost) {
  GraspObservation seen = SeenLever();
  double most = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    seen.seed = seed;
    const Eigen::Matrix3d hand = Grasp("gapartnet", seen).world_from_hand_rotation;
    EXPECT_TRUE(hand.col(2).isApprox(-Eigen::Vector3d::UnitX()));
    most = std::max(most, std::acos(std::min(1.0, hand.col(1).z())));
  }
  EXPECT_NEAR(most, 10 * kDegree, 1e-9);  // a twentieth of the draws is clipped there
}

Observation Held() {
  Observation seen;
  seen.privileged.world_from_hand = Translation({0.2, 0.5, 1});
  seen.privileged.world_from_hand.linear() << 0, 0, -1, 1, 0, 0, 0, -1, 0;
  seen.privileged.handle_origin_in_world = Eigen::Vector3d(0.1, 0.5, 1);
  seen.privileged.handle_axis_in_world = Eigen::Vector3d::UnitX();
  seen.privileged.hinge_axis_in_world = Eigen::Vector3d::UnitZ();
  return seen;
}

TEST(Gapartnet, TheCleanStepsAreArcsAboutTheTrueAxes) {
  const Observation seen = Held();
  const Action turn = Steps("gapartnet_clean", Stage::kHandle)->Act(seen);
  EXPECT_LT(turn.position_delta_m.norm(), 1e-12);  // the hand is on the handle's axis
  EXPECT_NEAR(RotationVector(turn.world_from_hand_rotation *
                             seen.privileged.world_from_hand.linear().transpose())
                  .dot(Eigen::Vector3d::UnitX()),
              5 * kDegree, 1e-12);
  const Action open = Steps("gapartnet_clean", Stage::kOpen)->Act(seen);
  const double reach = std::hypot(0.2, 0.5);
  EXPECT_NEAR(open.position_delta_m.norm(), 2 * reach * std::sin(1.5 * kDegree), 1e-12);
}

TEST(Gapartnet, TheDemonstrationPullsStraightAlongTheFirstDirection) {
  Observation seen = Held();
  const auto steps = Steps("gapartnet_pull", Stage::kOpen);
  steps->Reset();
  EXPECT_TRUE(steps->Act(seen).position_delta_m.isApprox(Eigen::Vector3d(0.025, 0, 0)));
  seen.privileged.world_from_handle = RotationAbout(Eigen::Vector3d::UnitZ(), 0.5);
  const Action later = steps->Act(seen);
  EXPECT_TRUE(later.position_delta_m.isApprox(Eigen::Vector3d(0.025, 0, 0)));
  EXPECT_TRUE(later.world_from_hand_rotation.isApprox(seen.privileged.world_from_hand.linear()));
}

TEST(Gapartnet, TheReleasedStepsAreThoseOfEachTask) {
  Observation seen = Held();
  DoorFacts& door = seen.privileged.door;
  const auto delta = [&](Stage stage) {
    return Steps("gapartnet", stage)->Act(seen).position_delta_m;
  };
  door = {Category::kInterior, Mechanism::kLever, HingeSide::kLeft, {}};
  EXPECT_TRUE(delta(Stage::kHandle).isApprox(Eigen::Vector3d(0, 0, -0.06)));
  EXPECT_TRUE(delta(Stage::kOpen).isApprox(Eigen::Vector3d(0.06, 0, 0)));
  door.category = Category::kWindow;
  EXPECT_TRUE(delta(Stage::kHandle).isApprox(Eigen::Vector3d(0, -0.04, 0)));
  door.category = Category::kCar;
  EXPECT_TRUE(delta(Stage::kHandle).isApprox(Eigen::Vector3d(0.045, 0, 0)));
  door.category = Category::kSafe;
  const Action twist = Steps("gapartnet", Stage::kHandle)->Act(seen);
  EXPECT_LT(twist.position_delta_m.norm(), 1e-12);
  EXPECT_NEAR(RotationVector(twist.world_from_hand_rotation *
                             seen.privileged.world_from_hand.linear().transpose())
                  .x(),
              25 * kDegree, 1e-9);
}

// A plain bar is what the heuristic is made for: arcs open it, straight pulls move it.
TEST(Gapartnet, APlainPullIsOpenedByArcsAndMovedByStraightPulls) {
  const DoorAsset door = MakePrimitiveDoor({.mechanism = Mechanism::kNone});
  const RobotModel robot = LoadMobileFranka();
  const Scene scene = SampleScene(door, 1, 0);
  const auto run = [&](const std::string& name) {
    return RunPolicySet({scene, door, robot},
                        PolicySetFactory(BuiltInPolicies(), {name, name, name}).Make(), nullptr);
  };
  const Episode clean = run("gapartnet_clean");
  EXPECT_EQ(clean.outcome, EpisodeOutcome::kOpened) << clean.detail;
  const Episode pull = run("gapartnet_pull");
  EXPECT_GT(pull.peak_hinge_rad, 10 * kDegree) << pull.detail;
}

}  // namespace
}  // namespace doorforge
