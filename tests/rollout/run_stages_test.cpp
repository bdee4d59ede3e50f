// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/expert_grasp.h"
#include "doorforge/rollout/grasp_from_policy.h"
#include "doorforge/rollout/handle_expert.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/random_grasp.h"
#include "doorforge/rollout/run_episode.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

class RunStagesTest : public testing::Test {
 protected:
  RunStagesTest() : robot_(LoadMobileFranka()) {}

  Episode Run(const DoorAsset& door, const Scene& scene, EpisodePolicies roles) const {
    OpeningExpert opens;
    roles.open = &opens;
    return RunStages(scene, door, robot_, roles, nullptr);
  }

  RobotModel robot_;
};

// Takes hold of the air before the leaf some times, then as the expert does.
class MissesFirst : public SnapshotGraspPolicy {
 public:
  MissesFirst(SnapshotGraspPolicy& expert, int misses) : expert_(expert), misses_(misses) {}
  std::optional<GraspCommand> Choose(const SceneSnapshot& snapshot) override {
    if (misses_-- <= 0) return expert_.Choose(snapshot);
    const RigidTransform& handle = snapshot.door[kHandleLink];
    GraspCommand beside;
    beside.contact_m =
        handle.translation() + 0.12 * handle.linear().col(0) - 0.15 * Eigen::Vector3d::UnitZ();
    beside.world_from_hand_rotation = HandTowards(-handle.linear().col(0));
    return beside;
  }

 private:
  static Eigen::Matrix3d HandTowards(const Eigen::Vector3d& approach) {
    Eigen::Matrix3d rotation;
    rotation.col(2) = approach;
    rotation.col(1) = Eigen::Vector3d::UnitZ();
    rotation.col(0) = rotation.col(1).cross(approach);
    return rotation;
  }

  SnapshotGraspPolicy& expert_;
  int misses_;
};

TEST_F(RunStagesTest, TakesHoldAgainAsOftenAsItMay) {
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  ExpertGrasp expert(scene, door, robot_);
  for (int misses = 0; misses < 3; ++misses) {
    for (int grasps = 1; grasps <= 3; ++grasps) {
      MissesFirst chooser(expert, misses);
      const Episode episode = Run(door, scene, {.grasp = &chooser, .grasps = grasps});
      EXPECT_EQ(episode.outcome == EpisodeOutcome::kOpened, grasps > misses)
          << misses << ", " << grasps << ": " << episode.detail;
      EXPECT_EQ(episode.grasps, std::min(grasps, misses + 1));
    }
  }
}

// Takes hold where the handle is now.
class FollowsTheHandle : public SnapshotGraspPolicy {
 public:
  FollowsTheHandle(const DoorAsset& door, const RobotModel& robot)
      : handle_from_hand_(door.handle_from_grasp * robot.hand_from_tcp().inverse()),
        handle_from_grasp_(door.handle_from_grasp) {}
  std::optional<GraspCommand> Choose(const SceneSnapshot& snapshot) override {
    GraspCommand grasp;
    grasp.world_from_hand_rotation = (snapshot.door[kHandleLink] * handle_from_hand_).linear();
    grasp.contact_m = (snapshot.door[kHandleLink] * handle_from_grasp_).translation() -
                      kGraspInsertion * grasp.world_from_hand_rotation.col(2);
    return grasp;
  }

 private:
  RigidTransform handle_from_hand_;
  RigidTransform handle_from_grasp_;
};

TEST_F(RunStagesTest, ADoorThatWasLeftAjarIsTakenHoldOfAgain) {
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  FollowsTheHandle chooser(door, robot_);
  for (const int grasps : {1, 2}) {
    int asked = 0;
    const auto gives_up = [&asked] { return ++asked == 4; };  // at some 12 degrees
    const Episode episode =
        Run(door, scene, {.grasp = &chooser, .gives_up = gives_up, .grasps = grasps});
    EXPECT_EQ(episode.outcome, EpisodeOutcome::kOpened) << episode.detail;  // the last goes on
    EXPECT_EQ(episode.grasps, grasps);
  }
}

// A leaf of 20 x 20 points at x = 0, and a handle of 5 in front of it.
LabelledCloud SmallCloud() {
  LabelledCloud cloud;
  const auto add = [&](double x, double y, double z, PointLabel label) {
    for (const double c : {x, y, z}) cloud.xyz.push_back(static_cast<float>(c));
    cloud.label.push_back(static_cast<std::uint8_t>(label));
  };
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < 20; ++k) add(0, 0.05 * i, 0.5 + 0.05 * k, PointLabel::kBody);
  }
  for (int i = 0; i < 5; ++i) add(0.02, 0.4 + 0.02 * i, 1, PointLabel::kHandle);
  return cloud;
}

// Remembers what it is shown, and takes hold of the handle's middle.
class Onlooker : public GraspPolicy {
 public:
  std::optional<GraspAction> Choose(const GraspObservation& observation) override {
    tried_.push_back(observation.tried.size());
    GraspAction action;
    action.contact_m = observation.privileged.world_from_handle.translation();
    return action;
  }
  const std::vector<std::size_t>& tried() const { return tried_; }

 private:
  std::vector<std::size_t> tried_;
};

TEST_F(RunStagesTest, ALeafThatHasTurnedIsLookedAtAnewAndNothingWasTriedThere) {
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  Onlooker policy;
  int looks = 0;
  GraspFromPolicy chooser(policy, scene, door, robot_, [&looks](const auto&) {
    ++looks;
    return SmallCloud();
  });
  std::vector<int> looks_then;
  for (const double hinge_rad : {0.0, 2 * kDegree, 10 * kDegree, 11 * kDegree, 0.0}) {
    SceneSnapshot snapshot;
    const auto links = DoorFromLinks(door, hinge_rad, 0);
    snapshot.door = {links[0], links[1], links[2]};
    chooser.Choose(snapshot);
    looks_then.push_back(looks);
  }
  EXPECT_EQ(looks_then, (std::vector{1, 1, 2, 2, 3}));
  EXPECT_EQ(policy.tried(), (std::vector<std::size_t>{0, 1, 0, 1, 0}));
}

TEST_F(RunStagesTest, TurnsOfTheHandleAddUpToDoneAndTheDoorOpens) {
  for (const Mechanism mechanism : {Mechanism::kLever, Mechanism::kRound}) {
    for (std::uint64_t i = 0; i < 4; ++i) {
      const DoorAsset door = MakePrimitiveDoor(RandomPrimitive(mechanism, 21, i));
      HandleExpert turns;
      const Episode episode =
          Run(door, SampleScene(door, 21, i), {.recorded = Stage::kHandle, .handle = &turns});
      EXPECT_EQ(episode.outcome, EpisodeOutcome::kOpened)
          << NameOf(mechanism) << " " << i << ": " << episode.detail;
      ASSERT_FALSE(episode.decisions.empty());
      double handle = episode.decisions[0].handle_rad;
      for (const Decision& decision : episode.decisions) {
        EXPECT_DOUBLE_EQ(decision.handle_rad, handle);
        EXPECT_LT(decision.hinge_rad, 1 * kDegree);
        handle += decision.angle_gain_rad;
      }
      EXPECT_GE(handle, door.latch.handle_done_angle_rad);
    }
  }
}

class Staying : public Policy {
 public:
  Action Act(const Observation& observation) override {
    return {Eigen::Vector3d::Zero(), observation.privileged.world_from_hand.linear()};
  }
};

TEST_F(RunStagesTest, AHandThatDoesNotTurnLeavesTheHandleStuck) {
  Staying stays;
  const DoorAsset door = MakePrimitiveDoor({});
  Scene scene = SampleScene(door, 1, 0);
  scene.physics.max_handle_actions = 3;
  const Episode episode = Run(door, scene, {.recorded = Stage::kHandle, .handle = &stays});
  EXPECT_EQ(episode.outcome, EpisodeOutcome::kHandleStuck) << episode.detail;
  EXPECT_EQ(episode.decisions.size(), 3U);
}

// Says that the handle is turned after so many questions, whatever has become of it.
HandleTurned AfterQuestions(int count) {
  return [count, asked = 0]() mutable { return ++asked >= count; };
}

TEST_F(RunStagesTest, APredictedFlagThatComesInTimeChangesNothing) {
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  HandleExpert turns;
  EpisodePolicies roles{.recorded = Stage::kHandle, .handle = &turns};
  const Episode told = Run(door, scene, roles);
  ASSERT_EQ(told.outcome, EpisodeOutcome::kOpened) << told.detail;
  roles.handle_turned = AfterQuestions(static_cast<int>(told.decisions.size()));
  const Episode predicted = Run(door, scene, roles);
  EXPECT_EQ(predicted.state_sha256, told.state_sha256);
  EXPECT_EQ(predicted.decisions.size(), told.decisions.size());
  EXPECT_TRUE(predicted.handle_turned);
}

TEST_F(RunStagesTest, APredictedFlagThatComesTooEarlyLeavesTheHandleStuckAndIsNamed) {
  const DoorAsset door = MakePrimitiveDoor({});
  HandleExpert turns;
  const Episode episode =
      Run(door, SampleScene(door, 1, 0),
          {.recorded = Stage::kHandle, .handle = &turns, .handle_turned = AfterQuestions(1)});
  EXPECT_EQ(episode.decisions.size(), 1U);
  EXPECT_EQ(episode.outcome, EpisodeOutcome::kHandleStuck) << episode.detail;
  EXPECT_FALSE(episode.handle_turned);
  EXPECT_NE(episode.detail.find("the switch came with the handle at"), std::string::npos)
      << episode.detail;
}

TEST_F(RunStagesTest, WhereThePredictedFlagNeverComesOpeningIsTriedAllTheSame) {
  const DoorAsset door = MakePrimitiveDoor({});
  Scene scene = SampleScene(door, 1, 0);
  scene.physics.max_handle_actions = 6;
  EpisodePolicies roles{.recorded = Stage::kHandle, .handle_turned = [] { return false; }};
  HandleExpert turns;
  roles.handle = &turns;
  const Episode turned = Run(door, scene, roles);
  EXPECT_EQ(turned.decisions.size(), 6U);
  EXPECT_EQ(turned.outcome, EpisodeOutcome::kOpened) << turned.detail;
  EXPECT_TRUE(turned.handle_turned);

  Staying stays;
  roles.handle = &stays;
  const Episode still = Run(door, scene, roles);
  EXPECT_EQ(still.decisions.size(), 6U);
  EXPECT_EQ(still.outcome, EpisodeOutcome::kHandleStuck) << still.detail;
  EXPECT_FALSE(still.handle_turned);
  EXPECT_NE(still.detail.find("no switch came, opening was tried with the handle at"),
            std::string::npos)
      << still.detail;
}

TEST_F(RunStagesTest, WhereNothingIsSaidOfTheHandleTheSimulatorSays) {
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  HandleExpert turns;
  EpisodePolicies roles{.recorded = Stage::kHandle, .handle = &turns};
  const Episode simulated = Run(door, scene, roles);
  roles.handle_turned = [] { return std::nullopt; };
  const Episode silent = Run(door, scene, roles);
  EXPECT_EQ(silent.state_sha256, simulated.state_sha256);

  Staying stays;
  roles.handle = &stays;
  EXPECT_EQ(Run(door, scene, roles).detail.find("no switch came"), std::string::npos);
}

TEST_F(RunStagesTest, ALearnerDrivesFirstAndTheRuleSaysWhatItWouldHaveDone) {
  const DoorAsset door = MakePrimitiveDoor({});
  Scene scene = SampleScene(door, 1, 0);
  scene.physics.action_noise_m = 0.002;
  Staying stays;
  const Episode episode =
      Run(door, scene, {.recorded = Stage::kOpen, .learner = &stays, .learner_decisions = 3});
  EXPECT_EQ(episode.outcome, EpisodeOutcome::kOpened) << episode.detail;
  ASSERT_GT(episode.decisions.size(), 6U);
  const auto way = [](const ActionVector& action) {
    return Eigen::Vector3f(action[0], action[1], action[2]).norm();
  };
  for (std::size_t t = 0; t < 3; ++t) {
    EXPECT_EQ(way(episode.decisions[t].executed), 0.0F);
    EXPECT_GT(way(episode.decisions[t].action), 0.005F);
    EXPECT_LT(episode.decisions[t].angle_gain_rad, 1 * kDegree);
  }
  for (std::size_t t = 3; t < episode.decisions.size(); ++t) {
    const Decision& decision = episode.decisions[t];
    EXPECT_GT(way(decision.executed), 0.01F);
    EXPECT_NE(decision.executed, decision.action);  // the noise
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(decision.executed[k], decision.action[k], 6 * 0.002);
  }
}

TEST_F(RunStagesTest, TheRecordedJointsSayWhereTheHandIs) {
  const DoorAsset door = MakePrimitiveDoor({});
  HandleExpert turns;
  const Scene scene = SampleScene(door, 1, 0);
  const Episode episode = Run(door, scene, {.recorded = Stage::kHandle, .handle = &turns});
  ASSERT_FALSE(episode.decisions.empty());
  for (const Decision& decision : episode.decisions) {
    JointVector joints(kRobotJointCount);
    std::copy_n(decision.state.begin(), kRobotJointCount, joints.begin());
    const Eigen::Vector3d hand =
        robot_.PoseAt(joints, scene.world_from_robot_base).world_from_hand.translation();
    const Eigen::Vector3f known = HandPositionOf(decision.proprioception);
    EXPECT_LT((hand.cast<float>() - known).norm(), 1e-6F);
    EXPECT_EQ(decision.state[kStateHinge], decision.hinge_rad);
    EXPECT_EQ(decision.state[kStateHandle], decision.handle_rad);
  }
}

// Takes hold at a point given in the handle's grasp frame.
class FixedGrasp : public SnapshotGraspPolicy {
 public:
  FixedGrasp(const DoorAsset& door, const RobotModel& robot, const Eigen::Vector3d& offset_m)
      : handle_from_grasp_(door.handle_from_grasp),
        tcp_from_hand_(robot.hand_from_tcp().linear().transpose()),
        offset_m_(offset_m) {}

  std::optional<GraspCommand> Choose(const SceneSnapshot& snapshot) override {
    const RigidTransform grasp = snapshot.door[kHandleLink] * handle_from_grasp_;
    GraspCommand chosen;
    chosen.contact_m = grasp * (offset_m_ - kGraspInsertion * Eigen::Vector3d::UnitZ());
    chosen.world_from_hand_rotation = grasp.linear() * tcp_from_hand_;
    return chosen;
  }

 private:
  RigidTransform handle_from_grasp_;
  Eigen::Matrix3d tcp_from_hand_;
  Eigen::Vector3d offset_m_;
};

TEST_F(RunStagesTest, AGoodGraspScoresTheDoorsFinalAngleAndAnEmptyOneNothing) {
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  HandleExpert turns;
  FixedGrasp good(door, robot_, {0, 0, 0});
  const Episode opened =
      Run(door, scene, {.recorded = Stage::kGrasp, .grasp = &good, .handle = &turns});
  EXPECT_EQ(opened.outcome, EpisodeOutcome::kOpened) << opened.detail;
  ASSERT_EQ(opened.decisions.size(), 1U);
  EXPECT_GT(opened.decisions[0].angle_gain_rad, 45 * kDegree);
  EXPECT_EQ(opened.decisions[0].time_s, 0);

  FixedGrasp empty(door, robot_, {0, 0, -0.12});
  const Episode missed =
      Run(door, scene, {.recorded = Stage::kGrasp, .grasp = &empty, .handle = &turns});
  EXPECT_EQ(missed.outcome, EpisodeOutcome::kGraspMissed) << missed.detail;
  ASSERT_EQ(missed.decisions.size(), 1U);
  EXPECT_LT(missed.decisions[0].angle_gain_rad, 0.01);
}

TEST_F(RunStagesTest, ADoorWithoutALatchNeedsNoTurn) {
  const DoorAsset door = MakePrimitiveDoor({.mechanism = Mechanism::kNone});
  HandleExpert turns;
  const Episode episode =
      Run(door, SampleScene(door, 1, 0), {.recorded = Stage::kHandle, .handle = &turns});
  EXPECT_EQ(episode.outcome, EpisodeOutcome::kOpened) << episode.detail;
  EXPECT_TRUE(episode.decisions.empty());
}

TEST_F(RunStagesTest, WhoSaysWhenTheHandleIsTurnedIsNotToldThatThereIsNoLatch) {
  const DoorAsset door = MakePrimitiveDoor({.mechanism = Mechanism::kNone});
  HandleExpert turns;
  const Episode episode =
      Run(door, SampleScene(door, 1, 0),
          {.recorded = Stage::kHandle, .handle = &turns, .handle_turned = AfterQuestions(2)});
  EXPECT_EQ(episode.decisions.size(), 2U) << "as on a door with a latch";
  EXPECT_EQ(episode.outcome, EpisodeOutcome::kOpened) << episode.detail;
}

TEST_F(RunStagesTest, RefusesAStageAtWhichNobodyDecides) {
  const DoorAsset door = MakePrimitiveDoor({});
  EXPECT_THROW(Run(door, SampleScene(door, 1, 0), {.recorded = Stage::kHandle}), Error);
  EXPECT_THROW(Run(door, SampleScene(door, 1, 0), {.recorded = Stage::kGrasp}), Error);
}

// ---- sampled grasps -----------------------------------------------------------------------------

struct Sampled {
  int on_handle = 0;
  int near = 0;  // turned less than three spreads from the handle's own grasp
};

TEST_F(RunStagesTest, SampledGraspsAreOnTheHandleAndTurnedAsAskedFor) {
  const DoorAsset door = MakePrimitiveDoor({});
  Scene scene = SampleScene(door, 1, 0);
  const RandomGraspConfig config{.near_share = 0.5, .near_turn_rad = 0.05, .beside_share = 0.25};
  SceneSnapshot snapshot;
  const auto links = DoorFromLinks(door, 0, 0);
  snapshot.door = {links[0], links[1], links[2]};
  const Eigen::Matrix3d own = links[kHandleLink].linear() * door.handle_from_grasp.linear() *
                              robot_.hand_from_tcp().linear().transpose();
  constexpr int kCount = 400;
  Sampled sampled;
  for (int i = 0; i < kCount; ++i) {
    scene.episode = static_cast<std::uint64_t>(i);
    RandomGraspPolicy policy(config);
    GraspFromPolicy random(policy, scene, door, robot_, [](const auto&) { return SmallCloud(); });
    random.RecordWith({64});
    const auto chosen = random.Choose(snapshot);
    ASSERT_TRUE(chosen.has_value());
    ASSERT_EQ(chosen->cloud.label.size(), 64U);
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(chosen->cloud.xyz[static_cast<std::size_t>(k)],
                static_cast<float>(chosen->contact_m[k]));
    sampled.on_handle += chosen->cloud.label[0] == 1 ? 1 : 0;
    const Eigen::Matrix3d turn = own.transpose() * chosen->world_from_hand_rotation;
    EXPECT_LT((turn.transpose() * turn - Eigen::Matrix3d::Identity()).norm(), 1e-9);
    sampled.near += std::abs(std::atan2(turn(1, 0), turn(0, 0))) < 0.15 ? 1 : 0;
  }
  // binomial, five standard deviations: 0.75; 0.5 * 0.997 + 0.5 * 0.3 / pi = 0.546
  EXPECT_NEAR(sampled.on_handle / double{kCount}, 0.75, 5 * 0.0217);
  EXPECT_NEAR(sampled.near / double{kCount}, 0.546, 5 * 0.025);
}

TEST_F(RunStagesTest, NothingIsChosenWhereNoHandleIsInView) {
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  RandomGraspPolicy policy;
  GraspFromPolicy random(policy, scene, door, robot_, [](const auto&) {
    LabelledCloud cloud = SmallCloud();
    std::fill(cloud.label.begin(), cloud.label.end(), std::uint8_t{0});
    return cloud;
  });
  HandleExpert turns;
  const Episode episode =
      Run(door, scene, {.recorded = Stage::kGrasp, .grasp = &random, .handle = &turns});
  EXPECT_EQ(episode.outcome, EpisodeOutcome::kNotReached);
  EXPECT_TRUE(episode.decisions.empty());
}

}  // namespace
}  // namespace doorforge
