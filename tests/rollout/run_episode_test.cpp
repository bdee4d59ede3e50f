// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/run_episode.h"

#include <array>
#include <numbers>
#include <thread>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/proprioception.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

constexpr double kOneDegree = std::numbers::pi / 180;

class RunEpisodeTest : public testing::Test {
 protected:
  RunEpisodeTest() : robot_(LoadMobileFranka()) {}

  Episode Run(const DoorAsset& door, const Scene& scene) const {
    OpeningExpert expert;
    return RunEpisode(scene, door, robot_, expert, nullptr);
  }

  RobotModel robot_;
};

// Pulls straight back and never follows the arc.
class StayingPolicy : public Policy {
 public:
  Action Act(const Observation& observation) override {
    return {Eigen::Vector3d::Zero(), observation.privileged.world_from_hand.linear()};
  }
};

TEST_F(RunEpisodeTest, TheExpertOpensRandomDoorsOfEachMechanism) {
  for (const Mechanism mechanism : {Mechanism::kLever, Mechanism::kRound, Mechanism::kNone}) {
    for (std::uint64_t i = 0; i < 5; ++i) {
      const DoorAsset door = MakePrimitiveDoor(RandomPrimitive(mechanism, 21, i));
      const Episode episode = Run(door, SampleScene(door, 21, i));
      EXPECT_EQ(episode.outcome, EpisodeOutcome::kOpened)
          << NameOf(mechanism) << " " << i << ": " << episode.detail;
      EXPECT_GT(episode.peak_hinge_rad, 45 * kOneDegree);
      EXPECT_LE(episode.decisions.size(), 25U);
      if (mechanism != Mechanism::kNone) {
        EXPECT_GE(episode.peak_handle_rad, door.latch.handle_done_angle_rad);
      }
    }
  }
}

// A vertical bar in a deep frame, 35 mm from the jamb: opened fingers would not pass, and the arm
// has to leave the frame before it turns the hand.
TEST_F(RunEpisodeTest, TheExpertPushesWhatLiesDeepInAFrame) {
  DoorAsset door = MakePrimitiveDoor({.mechanism = Mechanism::kNone, .opening = Opening::kPush});
  const std::array<TriangleMesh, 4> frame = {
      BoxMesh({0.025, -0.1, 0.3}, {0.15, 0.0, 1.3}), BoxMesh({0.025, 0.775, 0.3}, {0.15, 0.9, 1.3}),
      BoxMesh({0.025, -0.1, 0.2}, {0.15, 0.9, 0.3}), BoxMesh({0.025, -0.1, 1.3}, {0.15, 0.9, 1.4})};
  for (const TriangleMesh& bar : frame) {
    DoorGeometry piece;
    piece.name = "frame" + std::to_string(door.links[kBaseLink].geometry.size());
    piece.mesh = bar;
    piece.hulls = {bar};
    door.links[kBaseLink].geometry.push_back(piece);
  }
  int opened = 0;
  for (std::uint64_t i = 0; i < 4; ++i) {
    const Episode episode = Run(door, SampleScene(door, 21, i));
    opened += episode.outcome == EpisodeOutcome::kOpened ? 1 : 0;
  }
  EXPECT_GE(opened, 3) << "a grasp straight in opens none of the four";
}

struct DoorKind {
  Mechanism mechanism;
  HingeSide hinge_side;
  Opening opening;
  LatchType latch;
  Simulator simulator = Simulator::kBullet;
};

class DoorKinds : public testing::TestWithParam<DoorKind> {};

TEST_P(DoorKinds, AreOpenedByTheExpert) {
  const RobotModel robot = LoadMobileFranka();
  for (std::uint64_t i = 0; i < 3; ++i) {
    PrimitiveDoor described = RandomPrimitive(GetParam().mechanism, 23, i);
    described.hinge_side = GetParam().hinge_side;
    described.opening = GetParam().opening;
    DoorAsset door = MakePrimitiveDoor(described);
    door.latch.type = GetParam().latch;
    if (GetParam().latch == LatchType::kBolt) door.latch.bolt_throw_m = 0.012;
    OpeningExpert expert;
    SceneConfig config;
    config.physics.simulator = GetParam().simulator;
    const Scene scene = SampleScene(door, 23, i, config);
    const Episode episode = RunEpisode(scene, door, robot, expert, nullptr);
    EXPECT_EQ(episode.outcome, EpisodeOutcome::kOpened) << "door " << i << ": " << episode.detail;
    // no door gives way before its handle is turned
    EXPECT_GT(episode.peak_handle_rad, door.latch.unlock_angle_rad) << "door " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, DoorKinds,
    testing::Values(
        DoorKind{Mechanism::kLever, HingeSide::kRight, Opening::kPull, LatchType::kEffort},
        DoorKind{Mechanism::kLever, HingeSide::kLeft, Opening::kPush, LatchType::kEffort},
        DoorKind{Mechanism::kRound, HingeSide::kRight, Opening::kPush, LatchType::kEffort},
        DoorKind{Mechanism::kLever, HingeSide::kLeft, Opening::kPull, LatchType::kBolt},
        DoorKind{Mechanism::kRound, HingeSide::kRight, Opening::kPull, LatchType::kBolt},
        DoorKind{Mechanism::kLever, HingeSide::kRight, Opening::kPush, LatchType::kBolt},
        DoorKind{Mechanism::kLever, HingeSide::kLeft, Opening::kPull, LatchType::kEffort,
                 Simulator::kMujoco},
        DoorKind{Mechanism::kRound, HingeSide::kRight, Opening::kPull, LatchType::kEffort,
                 Simulator::kMujoco},
        DoorKind{Mechanism::kLever, HingeSide::kLeft, Opening::kPush, LatchType::kEffort,
                 Simulator::kMujoco},
        DoorKind{Mechanism::kLever, HingeSide::kLeft, Opening::kPull, LatchType::kBolt,
                 Simulator::kMujoco},
        DoorKind{Mechanism::kRound, HingeSide::kLeft, Opening::kPull, LatchType::kBolt,
                 Simulator::kMujoco}));

TEST_F(RunEpisodeTest, DecisionsAddUpToTheDoorsAngleASixthOfASecondApart) {
  const DoorAsset door = MakePrimitiveDoor({});
  const Episode episode = Run(door, SampleScene(door, 1, 0));
  ASSERT_FALSE(episode.decisions.empty());
  double hinge = episode.decisions[0].hinge_rad;
  for (std::size_t i = 0; i < episode.decisions.size(); ++i) {
    const Decision& decision = episode.decisions[i];
    EXPECT_DOUBLE_EQ(decision.hinge_rad, hinge);
    hinge += decision.angle_gain_rad;
    if (i > 0) {
      EXPECT_NEAR(decision.time_s - episode.decisions[i - 1].time_s, 1.0 / 6, 1e-9);
    }
    EXPECT_TRUE(decision.cloud.label.empty());
  }
  EXPECT_NEAR(hinge, episode.peak_hinge_rad, 0.02);
}

TEST_F(RunEpisodeTest, EqualScenesGiveEqualHashesAlsoInTwoThreads) {
  const DoorAsset door = MakePrimitiveDoor({});
  for (const Simulator simulator : {Simulator::kBullet, Simulator::kMujoco}) {
    SceneConfig config;
    config.physics.simulator = simulator;
    const Scene scene = SampleScene(door, 1, 0, config);
    const std::string expected = Run(door, scene).state_sha256;
    std::array<std::string, 2> hashes;
    std::thread first([&] { hashes[0] = Run(door, scene).state_sha256; });
    std::thread second([&] { hashes[1] = Run(door, scene).state_sha256; });
    first.join();
    second.join();
    EXPECT_EQ(hashes[0], expected) << NameOf(simulator);
    EXPECT_EQ(hashes[1], expected) << NameOf(simulator);
    EXPECT_NE(Run(door, SampleScene(door, 1, 1, config)).state_sha256, expected);
  }
}

TEST_F(RunEpisodeTest, AKnobTooSlipperyToTurnIsAHandleSlipped) {
  PrimitiveDoor shape;
  shape.mechanism = Mechanism::kRound;
  const DoorAsset door = MakePrimitiveDoor(shape);
  Scene scene = SampleScene(door, 1, 0);
  // torque of two pads: 2 * mu * 80 N * 2.8 cm, against a spring of 3 N m/rad * 0.51 rad
  scene.physics.finger_friction = 0.1;
  const Episode episode = Run(door, scene);
  EXPECT_EQ(episode.outcome, EpisodeOutcome::kHandleSlipped) << episode.detail;
}

TEST_F(RunEpisodeTest, AHandleWithTooStrongASpringIsStuck) {
  const DoorAsset door = MakePrimitiveDoor({});
  Scene scene = SampleScene(door, 1, 0);
  scene.latch.handle_spring_nm_per_rad = 200;  // 100 N m, more than the arm has
  const Episode episode = Run(door, scene);
  EXPECT_TRUE(episode.outcome == EpisodeOutcome::kHandleStuck ||
              episode.outcome == EpisodeOutcome::kHandleSlipped)
      << episode.detail;
  EXPECT_LT(episode.peak_handle_rad, scene.latch.unlock_angle_rad);
}

TEST_F(RunEpisodeTest, AGraspBesideTheHandleIsMissed) {
  DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  door.handle_from_grasp.translate(Eigen::Vector3d(0, 0, -0.12));  // in front of the bar
  const Episode episode = Run(door, scene);
  EXPECT_EQ(episode.outcome, EpisodeOutcome::kGraspMissed) << episode.detail;
  EXPECT_TRUE(episode.decisions.empty());
}

TEST_F(RunEpisodeTest, AHandleOutOfTheArmsReachIsNotReached) {
  const DoorAsset door = MakePrimitiveDoor({});
  Scene scene = SampleScene(door, 1, 0);
  scene.world_from_door.translation().z() = 1.6;
  const Episode episode = Run(door, scene);
  EXPECT_EQ(episode.outcome, EpisodeOutcome::kNotReached) << episode.detail;
}

// At the speed of the hand the way would take a day.
TEST_F(RunEpisodeTest, AHandleKilometresAwayIsNotReachedAtOnce) {
  const DoorAsset door = MakePrimitiveDoor({});
  Scene scene = SampleScene(door, 1, 0);
  scene.world_from_door.translation().x() = -20'000;
  const Episode episode = Run(door, scene);
  EXPECT_NE(episode.outcome, EpisodeOutcome::kOpened);
  EXPECT_LT(episode.simulated_s, 60);
}

TEST_F(RunEpisodeTest, AHandThatStaysLeavesTheDoorStuck) {
  const DoorAsset door = MakePrimitiveDoor({});
  Scene scene = SampleScene(door, 1, 0);
  scene.physics.max_opening_actions = 5;
  StayingPolicy staying;
  const Episode episode = RunEpisode(scene, door, robot_, staying, nullptr);
  EXPECT_EQ(episode.outcome, EpisodeOutcome::kDoorStuck) << episode.detail;
  EXPECT_EQ(episode.decisions.size(), 5U);
}

// Opens with a jerk and then holds the hand still in the air, away from the door.
class ThrowingPolicy : public Policy {
 public:
  void Reset() override { actions_ = 0; }
  Action Act(const Observation& observation) override {
    const PrivilegedState& now = observation.privileged;
    ++actions_;
    // out of the handle along the approach, backwards
    return {-0.2 * now.world_from_hand.linear().col(2), now.world_from_hand.linear()};
  }

 private:
  int actions_ = 0;
};

TEST_F(RunEpisodeTest, AHandTornOffTheHandleLosesItsGrip) {
  const DoorAsset door = MakePrimitiveDoor({});
  Scene scene = SampleScene(door, 1, 0);
  scene.physics.finger_force_n = 80;
  scene.physics.finger_friction = 0.4;
  scene.latch.hinge_spring_nm_per_rad = 400;
  ThrowingPolicy throwing;
  const Episode episode = RunEpisode(scene, door, robot_, throwing, nullptr);
  EXPECT_EQ(episode.outcome, EpisodeOutcome::kGripLost) << episode.detail;
}

TEST_F(RunEpisodeTest, ProprioceptionIsNormalisedAndInTheWorld) {
  WorldState state;
  state.robot_position = robot_.InitialPosition();
  state.robot_velocity = JointVector::Zero(robot_.joint_count());
  state.robot_velocity[4] = 0.5;
  const RigidTransform base = FromXyzRpy({0.7, 0.1, 0.1}, {0, 0, std::numbers::pi});
  const Proprioception numbers = ProprioceptionOf(robot_, state, base);
  EXPECT_NEAR(numbers[0], 0, 1e-6);  // slider in the middle
  EXPECT_NEAR(numbers[9], 1, 1e-6);  // finger wide open
  EXPECT_NEAR(numbers[11 + 4], 0.5, 1e-6);
  EXPECT_NEAR(BasePositionOf(numbers).x(), 0.7, 1e-6);
  const RigidTransform hand = robot_.PoseAt(state.robot_position, base).world_from_hand;
  EXPECT_NEAR(HandPositionOf(numbers).z(), hand.translation().z(), 1e-6);
  const Eigen::Quaterniond turn(numbers[31], numbers[28], numbers[29], numbers[30]);
  EXPECT_LT(turn.angularDistance(Eigen::Quaterniond(hand.linear())), 1e-5);
}

TEST_F(RunEpisodeTest, RefusesASceneOfAnotherDoor) {
  const DoorAsset door = MakePrimitiveDoor({});
  Scene scene = SampleScene(door, 1, 0);
  scene.door_id = "another";
  EXPECT_THROW(Run(door, scene), Error);
}

}  // namespace
}  // namespace doorforge
