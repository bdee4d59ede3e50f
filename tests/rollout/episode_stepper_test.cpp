// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/episode_stepper.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/expert_grasp.h"
#include "doorforge/rollout/handle_expert.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/reward.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

struct Kind {
  std::string name;
  Mechanism mechanism = Mechanism::kLever;
  LatchType latch = LatchType::kEffort;
  Opening opening = Opening::kPull;
  std::uint64_t index = 0;
};

const std::vector<Kind> kKinds = {{"lever", Mechanism::kLever},
                                  {"round", Mechanism::kRound, LatchType::kEffort, {}, 1},
                                  {"bolt", Mechanism::kLever, LatchType::kBolt, {}, 2},
                                  {"push", Mechanism::kLever, LatchType::kEffort, Opening::kPush},
                                  {"none", Mechanism::kNone, LatchType::kNone, {}, 3}};

DoorAsset DoorOf(const Kind& kind) {
  PrimitiveDoor described = RandomPrimitive(kind.mechanism, 23, kind.index);
  described.opening = kind.opening;
  DoorAsset door = MakePrimitiveDoor(described);
  door.latch.type = kind.latch;
  if (kind.latch == LatchType::kBolt) door.latch.bolt_throw_m = 0.012;
  return door;
}

// All that a caller is told, and the joints bit by bit.
struct Told {
  StepResult result;
  std::string state_sha256;
};

bool SameCloud(const LabelledCloud& a, const LabelledCloud& b) {
  return a.xyz == b.xyz && a.label == b.label;
}

void ExpectSame(const Told& a, const Told& b, const std::string& where) {
  EXPECT_EQ(a.state_sha256, b.state_sha256) << where;
  EXPECT_EQ(a.result.stage, b.result.stage) << where;
  EXPECT_EQ(a.result.reward, b.result.reward) << where;
  EXPECT_EQ(a.result.terminated, b.result.terminated) << where;
  EXPECT_EQ(a.result.truncated, b.result.truncated) << where;
  EXPECT_EQ(a.result.cause, b.result.cause) << where;
  EXPECT_EQ(a.result.observation.proprioception, b.result.observation.proprioception) << where;
  EXPECT_EQ(a.result.observation.privileged.world_from_hand.matrix(),
            b.result.observation.privileged.world_from_hand.matrix())
      << where;
  EXPECT_TRUE(SameCloud(a.result.observation.cloud, b.result.observation.cloud)) << where;
}

void ExpectSameEnd(const Episode& a, const Episode& b) {
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(a.detail, b.detail);
  EXPECT_EQ(a.state_sha256, b.state_sha256);
  EXPECT_EQ(a.peak_hinge_rad, b.peak_hinge_rad);
  EXPECT_EQ(a.peak_handle_rad, b.peak_handle_rad);
  EXPECT_EQ(a.peak_force_n, b.peak_force_n);
  EXPECT_EQ(a.simulated_s, b.simulated_s);
  EXPECT_EQ(a.handle_turned, b.handle_turned);
}

class EpisodeStepperTest : public testing::Test {
 protected:
  EpisodeStepperTest() : robot_(LoadMobileFranka()) {}

  Told Now(const EpisodeStepper& stepper) const {
    return {stepper.now(), stepper.Summary().state_sha256};
  }

  // Steps to the end by the two rules that decide action by action.
  std::vector<Told> Finish(EpisodeStepper& stepper, HandleExpert turns, OpeningExpert opens,
                           std::vector<Action>* actions = nullptr) const {
    std::vector<Told> told;
    while (!stepper.now().over()) {
      const StepResult& now = stepper.now();
      const Action action =
          now.stage == Stage::kHandle ? turns.Act(now.observation) : opens.Act(now.observation);
      if (actions != nullptr) actions->push_back(action);
      stepper.Step(action);
      told.push_back(Now(stepper));
    }
    return told;
  }

  std::string Refusal(EpisodeStepper& stepper, const Action& action) const {
    try {
      stepper.Step(action);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
      return error.what();
    }
    return "not refused";
  }

  RobotModel robot_;
};

TEST_F(EpisodeStepperTest, DrivenByHandItOpensAsRunEpisodeDoesBitByBit) {
  for (const Kind& kind : kKinds) {
    SCOPED_TRACE(kind.name);
    const DoorAsset door = DoorOf(kind);
    const Scene scene = SampleScene(door, 23, kind.index);
    OpeningExpert expert;
    const Episode expected = RunEpisode(scene, door, robot_, expert, nullptr);
    ASSERT_EQ(expected.outcome, EpisodeOutcome::kOpened) << expected.detail;

    EpisodeStepper stepper(door, robot_);
    Observation seen = stepper.Reset(scene);
    expert.Reset();
    std::vector<double> rewards;
    std::vector<double> worth;
    while (!stepper.now().over()) {
      const Action action = expert.Act(seen);
      EXPECT_EQ(ToVector(action), expected.decisions.at(rewards.size()).action);
      EXPECT_EQ(stepper.state().time_s, expected.decisions.at(rewards.size()).time_s);
      const PrivilegedState before = seen.privileged;
      const StepResult& result = stepper.Step(action);
      seen = result.observation;
      rewards.push_back(result.reward);
      worth.push_back(RewardOf(Stage::kOpen, {before, seen.privileged, action}));
    }
    ASSERT_EQ(rewards.size(), expected.decisions.size());
    EXPECT_EQ(rewards, worth);
    for (std::size_t t = 0; t < rewards.size(); ++t)
      EXPECT_EQ(rewards[t], expected.decisions[t].angle_gain_rad);
    EXPECT_EQ(stepper.now().cause, EpisodeOutcome::kOpened);
    EXPECT_TRUE(stepper.now().terminated);
    EXPECT_FALSE(stepper.now().truncated);
    ExpectSameEnd(stepper.Summary(), expected);
  }
}

TEST_F(EpisodeStepperTest, FromTheGraspOnItIsRunStagesBitByBit) {
  const DoorAsset door = DoorOf(kKinds[0]);
  const Scene scene = SampleScene(door, 23, 0);
  HandleExpert turns;
  OpeningExpert opens;
  ExpertGrasp takes(scene, door, robot_);
  const Episode expected = RunStages(
      scene, door, robot_,
      {.recorded = Stage::kHandle, .grasp = &takes, .handle = &turns, .open = &opens}, nullptr);
  ASSERT_EQ(expected.outcome, EpisodeOutcome::kOpened) << expected.detail;
  EpisodeStepper stepper(door, robot_, {.first = Stage::kGrasp});
  stepper.Reset(scene);
  EXPECT_EQ(stepper.now().stage, Stage::kGrasp);
  EXPECT_EQ(stepper.state().time_s, 0);
  stepper.Step(takes.Choose(stepper.Snapshot()));
  EXPECT_EQ(stepper.now().stage, Stage::kHandle);
  const std::vector<Told> told = Finish(stepper, HandleExpert(), OpeningExpert());
  ExpectSameEnd(stepper.Summary(), expected);
  for (std::size_t t = 0; t < expected.decisions.size(); ++t)
    EXPECT_EQ(told[t].result.reward, expected.decisions[t].angle_gain_rad);
}

TEST_F(EpisodeStepperTest, TheCloudsAreThoseThatRunEpisodeRecords) {
  const DoorAsset door = DoorOf(kKinds[0]);
  const Scene scene = SampleScene(door, 23, 0);
  CloudConfig config;
  config.point_count = 256;
  config.noise.sensor = DepthSensor::kStructuredLight;
  OpeningExpert expert;
  CameraObserver first(scene, door, robot_, config);
  const Episode expected = RunEpisode(scene, door, robot_, expert, &first);
  CameraObserver second(scene, door, robot_, config);
  EpisodeStepper stepper(door, robot_, {.clouds = {Stage::kOpen}});
  stepper.Reset(scene, &second);
  expert.Reset();
  for (const Decision& decision : expected.decisions) {
    const Observation& seen = stepper.now().observation;
    ASSERT_TRUE(SameCloud(seen.cloud, decision.cloud));
    stepper.Step(expert.Act(seen));
  }
  EXPECT_TRUE(stepper.now().over());
}

class CountingObserver : public Observer {
 public:
  LabelledCloud Observe(const SceneSnapshot& snapshot) override {
    phases.push_back(snapshot.phase);
    return {};
  }
  std::vector<EpisodePhase> phases;
};

TEST_F(EpisodeStepperTest, MakesNoPictureWhereNobodyAskedForOne) {
  const DoorAsset door = DoorOf(kKinds[0]);
  const Scene scene = SampleScene(door, 23, 0);
  CountingObserver observer;
  EpisodeStepper blind(door, robot_, {.first = Stage::kHandle});
  blind.Reset(scene, &observer);
  Finish(blind, HandleExpert(), OpeningExpert());
  EXPECT_TRUE(observer.phases.empty());
  EpisodeStepper sees(door, robot_, {.first = Stage::kHandle, .clouds = {Stage::kHandle}});
  sees.Reset(scene, &observer);
  const std::size_t steps = Finish(sees, HandleExpert(), OpeningExpert()).size();
  EXPECT_GT(observer.phases.size(), 0U);
  EXPECT_LT(observer.phases.size(), steps);
  for (const EpisodePhase phase : observer.phases) EXPECT_EQ(phase, EpisodePhase::kUnlock);
}

// Whoever comes back to a point gets the same bits from there on, whatever happened in between, and
// whoever saves changes nothing: with the latch engaged and free, before and in the grasp.
TEST_F(EpisodeStepperTest, ComesBackToAnyPointBitByBit) {
  for (const Kind& kind : kKinds) {
    SCOPED_TRACE(kind.name);
    const DoorAsset door = DoorOf(kind);
    const Scene scene = SampleScene(door, 23, kind.index);
    EpisodeStepper stepper(door, robot_, {.first = Stage::kHandle});
    stepper.Reset(scene);
    std::vector<Action> actions;
    const std::vector<Told> expected = Finish(stepper, HandleExpert(), OpeningExpert(), &actions);
    const Episode end = stepper.Summary();

    stepper.Reset(scene);
    std::vector<EpisodeImage> images;
    bool saved_locked = false;
    bool saved_free = false;
    for (std::size_t t = 0; t < actions.size(); ++t) {
      images.push_back(stepper.Save());
      (stepper.state().locked ? saved_locked : saved_free) = true;
      stepper.Step(actions[t]);
      ExpectSame(Now(stepper), expected[t], "saved before action " + std::to_string(t));
    }
    EXPECT_TRUE(saved_free);
    EXPECT_EQ(saved_locked, kind.latch != LatchType::kNone);
    for (std::size_t k = images.size(); k-- > 0;) {
      stepper.Restore(images[k]);
      // elsewhere first, on every other way back
      if (k % 2 == 0) {
        const Eigen::Matrix3d still = stepper.now().observation.privileged.world_from_hand.linear();
        stepper.Step(Action{{0.05, 0.02, 0}, still});
        stepper.Restore(images[k]);
      }
      for (std::size_t t = k; t < actions.size(); ++t) {
        stepper.Step(actions[t]);
        ExpectSame(Now(stepper), expected[t],
                   "from " + std::to_string(k) + ", action " + std::to_string(t));
      }
      ExpectSameEnd(stepper.Summary(), end);
    }
  }
}

TEST_F(EpisodeStepperTest, ComesBackBeforeTheGraspAsWell) {
  const DoorAsset door = DoorOf(kKinds[1]);
  const Scene scene = SampleScene(door, 23, 1);
  EpisodeStepper stepper(door, robot_, {.first = Stage::kGrasp});
  stepper.Reset(scene);
  const EpisodeImage start = stepper.Save();
  ExpertGrasp takes(scene, door, robot_);
  const std::optional<GraspCommand> grasp = takes.Choose(stepper.Snapshot());
  stepper.Step(grasp);
  const Told held = Now(stepper);
  stepper.Step(stepper.Restore(start).over() ? std::nullopt : grasp);
  ExpectSame(Now(stepper), held, "grasped again");
  stepper.Restore(start);
  stepper.Step(std::optional<GraspCommand>());
  EXPECT_EQ(stepper.now().cause, EpisodeOutcome::kNotReached);
  EXPECT_TRUE(stepper.now().terminated);
}

// The noise of a camera goes on from look to look, so it has to come back as well.
TEST_F(EpisodeStepperTest, TheNoiseOfTheCameraComesBackToo) {
  const DoorAsset door = DoorOf(kKinds[0]);
  const Scene scene = SampleScene(door, 23, 0);
  CloudConfig config;
  config.point_count = 64;
  config.noise.sensor = DepthSensor::kStructuredLight;
  CameraObserver camera(scene, door, robot_, config);
  EpisodeStepper stepper(door, robot_, {.clouds = {Stage::kOpen}});
  stepper.Reset(scene, &camera);
  OpeningExpert expert;
  stepper.Step(expert.Act(stepper.now().observation));
  const EpisodeImage image = stepper.Save();
  const OpeningExpert remembered = expert;
  std::vector<Told> expected;
  for (int t = 0; t < 3; ++t) {
    stepper.Step(expert.Act(stepper.now().observation));
    expected.push_back(Now(stepper));
  }
  stepper.Restore(image);
  expert = remembered;
  for (int t = 0; t < 3; ++t) {
    stepper.Step(expert.Act(stepper.now().observation));
    ExpectSame(Now(stepper), expected[static_cast<std::size_t>(t)], std::to_string(t));
  }
}

TEST_F(EpisodeStepperTest, RefusesStepsThatDoNotBelong) {
  const DoorAsset door = DoorOf(kKinds[4]);
  const Scene scene = SampleScene(door, 23, 3);
  EpisodeStepper stepper(door, robot_);
  const Action still{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
  EXPECT_NE(Refusal(stepper, still).find("call Reset() with a scene first"), std::string::npos);
  EXPECT_THROW(stepper.now(), Error);
  EXPECT_THROW(stepper.Save(), Error);

  stepper.Reset(scene);
  const EpisodeImage image = stepper.Save();
  EXPECT_THROW(stepper.Step(std::optional<GraspCommand>()), Error);
  EXPECT_THROW(stepper.Restore(EpisodeImage()), Error);
  OpeningExpert expert;
  while (!stepper.now().over()) stepper.Step(expert.Act(stepper.now().observation));
  const std::string late = Refusal(stepper, still);
  EXPECT_NE(late.find("the episode is over (opened)"), std::string::npos) << late;
  EXPECT_FALSE(stepper.Restore(image).over());  // the end is not the end for an image
  stepper.Reset(scene);
  EXPECT_THROW(stepper.Restore(image), Error);  // of an episode that Reset() has ended

  Scene other = scene;
  other.door_id = "another";
  EXPECT_THROW(stepper.Reset(other), Error);
  EXPECT_NO_THROW(stepper.now());  // the episode from before goes on
}

TEST_F(EpisodeStepperTest, RefusesActionsThatAreNoMotionByName) {
  const DoorAsset door = DoorOf(kKinds[4]);
  EpisodeStepper stepper(door, robot_);
  stepper.Reset(SampleScene(door, 23, 3));
  const std::string before = stepper.Summary().state_sha256;
  Action action{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
  action.position_delta_m.y() = std::nan("");
  EXPECT_NE(Refusal(stepper, action).find("action.position_delta_m.y: found nan"),
            std::string::npos)
      << Refusal(stepper, action);
  action.position_delta_m.y() = HUGE_VAL;
  EXPECT_NE(Refusal(stepper, action).find("position_delta_m.y: found inf"), std::string::npos);
  action.position_delta_m.setZero();
  action.world_from_hand_rotation(1, 2) = std::nan("");
  EXPECT_NE(Refusal(stepper, action).find("action.world_from_hand_rotation: has numbers"),
            std::string::npos);
  action.world_from_hand_rotation = 2 * Eigen::Matrix3d::Identity();
  EXPECT_NE(Refusal(stepper, action).find("off by 3 from being orthonormal"), std::string::npos)
      << Refusal(stepper, action);
  action.world_from_hand_rotation = -Eigen::Matrix3d::Identity();
  EXPECT_NE(Refusal(stepper, action).find("is a reflection"), std::string::npos);
  EXPECT_EQ(stepper.Summary().state_sha256, before);  // nothing of it was carried out
  // what a network in single precision says is near enough
  action.world_from_hand_rotation =
      (1 + 1e-6) * RotationAbout(Eigen::Vector3d::UnitZ(), 0.3).linear();
  EXPECT_EQ(Refusal(stepper, action), "not refused");
}

TEST_F(EpisodeStepperTest, AGraspThatIsLeftToTheRulesAfterwardsIsRatedByTheDoorsAngle) {
  const DoorAsset door = DoorOf(kKinds[0]);
  const Scene scene = SampleScene(door, 23, 0);
  OpeningExpert opens;
  const Episode expected = RunEpisode(scene, door, robot_, opens, nullptr);
  ExpertGrasp takes(scene, door, robot_);
  ExpertUnlock turns(scene, door);
  EpisodeStepper stepper(door, robot_, {.first = Stage::kGrasp, .turn = &turns, .open = &opens});
  stepper.Reset(scene);
  const StepResult& result = stepper.Step(takes.Choose(stepper.Snapshot()));
  EXPECT_EQ(result.cause, EpisodeOutcome::kOpened);
  EXPECT_GT(stepper.state().hinge_rad, std::numbers::pi / 4);
  EXPECT_EQ(result.reward, GraspRating(result.observation.privileged));
  ExpectSameEnd(stepper.Summary(), expected);

  // an action is a grasp there as well: this one is in the air
  stepper.Reset(scene);
  const RigidTransform hand = stepper.now().observation.privileged.world_from_hand;
  const StepResult& missed = stepper.Step(Action{hand.translation(), hand.linear()});
  EXPECT_TRUE(missed.terminated);
  EXPECT_EQ(missed.reward, GraspRating(missed.observation.privileged));
}

TEST_F(EpisodeStepperTest, AnEpisodeThatTheRulesLoseIsOverBeforeTheFirstStep) {
  DoorAsset door = DoorOf(kKinds[0]);
  const Scene scene = SampleScene(door, 23, 0);
  door.handle_from_grasp.translate(Eigen::Vector3d(0, 0, -0.12));  // in front of the bar
  EpisodeStepper stepper(door, robot_);
  stepper.Reset(scene);
  EXPECT_TRUE(stepper.now().terminated);
  EXPECT_EQ(stepper.now().cause, EpisodeOutcome::kGraspMissed);
}

TEST_F(EpisodeStepperTest, ActionsThatDoNothingAreTruncatedWhenTheyAreUsedUp) {
  const DoorAsset door = DoorOf(kKinds[4]);
  Scene scene = SampleScene(door, 23, 3);
  scene.physics.max_opening_actions = 3;
  EpisodeStepper stepper(door, robot_);
  stepper.Reset(scene);
  for (int t = 0; t < 3; ++t) {
    EXPECT_FALSE(stepper.now().over());
    const Eigen::Matrix3d still = stepper.now().observation.privileged.world_from_hand.linear();
    stepper.Step(Action{Eigen::Vector3d::Zero(), still});
  }
  EXPECT_TRUE(stepper.now().truncated);
  EXPECT_FALSE(stepper.now().terminated);
  EXPECT_EQ(stepper.now().cause, EpisodeOutcome::kDoorStuck);
}

// ---- thresholds ---------------------------------------------------------------------------------

class LimitsTest : public EpisodeStepperTest {
 protected:
  LimitsTest() : door_(DoorOf(kKinds[0])), scene_(SampleScene(door_, 23, 0)) {}

  Episode Run() const {
    OpeningExpert opens;
    HandleExpert turns;
    return RunStages(scene_, door_, robot_,
                     {.handle = by_policy_ ? &turns : nullptr, .open = &opens}, nullptr);
  }

  bool by_policy_ = false;
  DoorAsset door_;
  Scene scene_;
};

TEST_F(LimitsTest, ADoorIsOpenAtTheAngleThatTheSettingsSay) {
  scene_.physics.max_opening_actions = 8;
  const Episode stuck = Run();
  EXPECT_EQ(stuck.outcome, EpisodeOutcome::kDoorStuck) << stuck.detail;
  scene_.limits.open_angle_rad = 0.1;
  const Episode opened = Run();
  EXPECT_EQ(opened.outcome, EpisodeOutcome::kOpened) << opened.detail;
  EXPECT_NE(opened.detail.find("both pads at 6 deg"), std::string::npos) << opened.detail;
  EXPECT_EQ(opened.state_sha256, stuck.state_sha256);  // judged otherwise, moved alike
}

TEST_F(LimitsTest, AStuckHandleIsSlippedWhereLessSlipIsAllowed) {
  scene_.latch.handle_spring_nm_per_rad = 60;
  const Episode before = Run();
  scene_.limits.slip_m = 1e-4;
  const Episode strict = Run();
  EXPECT_EQ(strict.outcome, EpisodeOutcome::kHandleSlipped) << strict.detail;
  scene_.limits = {};
  scene_.limits.slip_m = 1;
  scene_.limits.slip_rad = 3;
  scene_.limits.lost_time_s = 10;
  const Episode generous = Run();
  EXPECT_NE(generous.outcome, EpisodeOutcome::kHandleSlipped) << generous.detail;
  EXPECT_LT(before.peak_handle_rad, scene_.latch.handle_done_angle_rad) << before.detail;
}

TEST_F(LimitsTest, FingersWithoutTimeToCloseMissTheHandle) {
  scene_.limits.close_time_s = 0.02;
  EXPECT_EQ(Run().outcome, EpisodeOutcome::kGraspMissed);
}

TEST_F(LimitsTest, AHandWithoutTimeToReachIsNotThere) {
  scene_.limits.farthest_move_m = 0.01;
  EXPECT_EQ(Run().outcome, EpisodeOutcome::kNotReached);
}

TEST_F(LimitsTest, ARuleWithoutTimeLeavesTheHandleStuck) {
  scene_.limits.turn_time_s = 0.05;
  EXPECT_EQ(Run().outcome, EpisodeOutcome::kHandleStuck);
  by_policy_ = true;  // whom it does not concern
  EXPECT_EQ(Run().outcome, EpisodeOutcome::kOpened);
}

TEST_F(LimitsTest, AreRefusedByNameWhereTheyMakeNoSense) {
  scene_.limits.turn_speed_rad_s = 0;
  try {
    Run();
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidConfig);
    EXPECT_STREQ(error.what(), "scene.limits.turn_speed_rad_s: found 0.0, allowed 0.001 to 100.0");
  }
}

}  // namespace
}  // namespace doorforge
