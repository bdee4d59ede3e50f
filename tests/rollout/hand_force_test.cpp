// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
//
// PhysicsConfig::hand_force_n: what a hand presses a door with is measured by the contacts, of
// which the limit of the drives knows nothing.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/named_enum.h"
#include "doorforge/physics/door_world.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/episode_stepper.h"
#include "doorforge/rollout/expert_grasp.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/rollout/snapshot_grasp_policy.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

constexpr double kMost = 80;  // [N]

std::vector<Simulator> SimulatorsAtHand() {
  std::vector<Simulator> simulators;
  for (const auto& [simulator, name] : kSimulators)
    if (HasSimulator(simulator)) simulators.push_back(simulator);
  return simulators;
}

class HandForceTest : public testing::Test {
 protected:
  HandForceTest() : robot_(LoadMobileFranka()) {}

  // A hand that holds the handle of a locked door and does as it is told for two seconds.
  Episode Press(const Scene& scene, const DoorAsset& door, const Eigen::Vector3d& move_m) const {
    EpisodeStepper stepper(door, robot_, {.first = Stage::kHandle});
    stepper.Reset(scene);
    for (int i = 0; i < 12 && !stepper.now().over(); ++i) stepper.Step(Moved(stepper, move_m));
    return stepper.Summary();
  }

  static Action Moved(const EpisodeStepper& stepper, const Eigen::Vector3d& move_m) {
    return {move_m, stepper.now().observation.privileged.world_from_hand.linear()};
  }

  RobotModel robot_;
};

TEST_F(HandForceTest, ALockedDoorIsPressedWithNoMuchMoreThanIsAllowedInAnyDirection) {
  const DoorAsset door = MakePrimitiveDoor(RandomPrimitive(Mechanism::kLever, 23, 0));
  for (const Simulator simulator : SimulatorsAtHand()) {
    for (const Eigen::Vector3d& way :
         {Eigen::Vector3d(-0.05, 0, 0), Eigen::Vector3d(0.05, 0, 0), Eigen::Vector3d(0, 0, 0.05)}) {
      SCOPED_TRACE(std::string(NameOf(simulator)) + ", x " + std::to_string(way.x()));
      Scene scene = SampleScene(door, 23, 0);
      scene.physics.simulator = simulator;
      const Episode free = Press(scene, door, way);
      scene.physics.hand_force_n = kMost;
      const Episode limited = Press(scene, door, way);
      EXPECT_GT(free.peak_net_force_n, 2 * kMost);
      EXPECT_LT(limited.peak_net_force_n, 1.5 * kMost);
      EXPECT_GT(limited.peak_net_force_n, 0.5 * kMost);  // it does press
    }
  }
}

TEST_F(HandForceTest, DoorsOpenWithinTheForce) {
  int opened = 0;
  for (const Mechanism mechanism : {Mechanism::kLever, Mechanism::kRound, Mechanism::kNone}) {
    for (std::uint64_t index = 0; index < 4; ++index) {
      const DoorAsset door = MakePrimitiveDoor(RandomPrimitive(mechanism, 12, index));
      Scene scene = SampleScene(door, 12, static_cast<int>(index));
      scene.physics.hand_force_n = kMost;
      OpeningExpert expert;
      const Episode episode = RunEpisode(scene, door, robot_, expert, nullptr);
      EXPECT_LT(episode.peak_net_force_n, 150) << door.id << ": " << episode.detail;
      if (episode.outcome == EpisodeOutcome::kOpened) ++opened;
    }
  }
  EXPECT_GE(opened, 11);
}

// Sends the hand into the leaf, beside the handle.
class MeetsTheLeaf : public SnapshotGraspPolicy {
 public:
  std::optional<GraspCommand> Choose(const SceneSnapshot& snapshot) override {
    const RigidTransform& handle = snapshot.door[kHandleLink];
    const Eigen::Vector3d approach = -handle.linear().col(0);
    GraspCommand beside;
    beside.contact_m = handle.translation() + 0.1 * approach - 0.15 * Eigen::Vector3d::UnitZ();
    beside.world_from_hand_rotation.col(2) = approach;
    beside.world_from_hand_rotation.col(1) = Eigen::Vector3d::UnitZ();
    beside.world_from_hand_rotation.col(0) = Eigen::Vector3d::UnitZ().cross(approach);
    return beside;
  }
};

TEST_F(HandForceTest, WhatAHandMeetsOnItsWayToTheHandleCounts) {
  const DoorAsset door = MakePrimitiveDoor(RandomPrimitive(Mechanism::kLever, 23, 0));
  const Scene scene = SampleScene(door, 23, 0);
  MeetsTheLeaf chooser;
  EpisodeStepper stepper(door, robot_, {.first = Stage::kHandle, .grasp = &chooser});
  stepper.Reset(scene);
  const Episode episode = stepper.Summary();
  EXPECT_EQ(episode.outcome, EpisodeOutcome::kCollision) << episode.detail;
  EXPECT_GT(episode.peak_force_n, kMost);
  EXPECT_GT(episode.peak_net_force_n, kMost);
}

// Fingers without friction slip off a knob as the hand goes up.
TEST_F(HandForceTest, AHandThatHasLostTheHandleStandsStill) {
  const DoorAsset door = MakePrimitiveDoor(RandomPrimitive(Mechanism::kRound, 23, 0));
  const auto moved_at_the_end = [&](double most_n) {
    Scene scene = SampleScene(door, 23, 0);
    scene.physics.finger_friction = 0.01;
    scene.physics.hand_force_n = most_n;
    EpisodeStepper stepper(door, robot_, {.first = Stage::kHandle});
    stepper.Reset(scene);
    const auto hand = [&] { return stepper.now().observation.privileged.world_from_hand; };
    Eigen::Vector3d before = hand().translation();
    for (int i = 0; i < 9 && !stepper.now().over(); ++i) {
      before = hand().translation();
      stepper.Step(Moved(stepper, {0, 0, 0.05}));
    }
    return (hand().translation() - before).norm();
  };
  EXPECT_GT(moved_at_the_end(0), 0.03);
  EXPECT_LT(moved_at_the_end(kMost), 0.001);
}

// At 5 cm/s 2 cm take 0.4 s; back along the fingers they take as long as without a limit.
TEST_F(HandForceTest, AnActionTakesAsLongAsItsWayButForTheWayBack) {
  const DoorAsset door = MakePrimitiveDoor(RandomPrimitive(Mechanism::kLever, 23, 0));
  Scene scene = SampleScene(door, 23, 0);
  const double usual_s = scene.physics.steps_per_action * scene.physics.time_step_s;
  const auto time_s = [&](double most_n, double forward_m, double up_m) {
    scene.physics.hand_force_n = most_n;
    EpisodeStepper stepper(door, robot_, {.first = Stage::kHandle});
    stepper.Reset(scene);
    const RigidTransform hand = stepper.now().observation.privileged.world_from_hand;
    const double before_s = stepper.Summary().simulated_s;
    stepper.Step(Moved(stepper, forward_m * hand.linear().col(2) + Eigen::Vector3d(0, 0, up_m)));
    return stepper.Summary().simulated_s - before_s;
  };
  EXPECT_NEAR(time_s(0, 0.02, 0.02), usual_s, 1e-9);
  EXPECT_NEAR(time_s(kMost, 0, 0), usual_s, 1e-9);
  EXPECT_NEAR(time_s(kMost, -0.03, 0), usual_s, 1e-9);
  EXPECT_NEAR(time_s(kMost, 0, 0.02), 0.4, 0.01);
  EXPECT_NEAR(time_s(kMost, -0.03, 0.02), 0.4, 0.02);
  EXPECT_NEAR(time_s(kMost, 0.8, 0), 8 * usual_s, 1e-9);
}

// The share of the drives that is left is part of what an episode comes back to.
TEST_F(HandForceTest, ComesBackWhileItPresses) {
  const DoorAsset door = MakePrimitiveDoor(RandomPrimitive(Mechanism::kLever, 23, 0));
  Scene scene = SampleScene(door, 23, 0);
  scene.physics.hand_force_n = kMost;
  EpisodeStepper stepper(door, robot_, {.first = Stage::kHandle});
  stepper.Reset(scene);
  const Eigen::Vector3d pull(-0.05, 0, 0);
  for (int i = 0; i < 4; ++i) stepper.Step(Moved(stepper, pull));
  const EpisodeImage image = stepper.Save();
  const auto go_on = [&] {
    for (int i = 0; i < 3; ++i) stepper.Step(Moved(stepper, pull));
    return stepper.Summary().state_sha256;
  };
  const std::string first = go_on();
  for (int i = 0; i < 3; ++i) stepper.Step(Moved(stepper, -pull));
  stepper.Restore(image);
  EXPECT_EQ(go_on(), first);
}

}  // namespace
}  // namespace doorforge
