// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/hand_stepper.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/base_placement.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

SceneConfig FlyingScene() {
  SceneConfig config;
  config.physics.base = RobotBase::kFloating;
  return config;
}

const RobotModel& FlyingHand() {
  static const RobotModel robot = LoadRobot({}, RobotBase::kFloating);
  return robot;
}

DoorAsset DoorWith(Mechanism mechanism) {
  return MakePrimitiveDoor(RandomPrimitive(mechanism, 23, 0));
}

Scene SceneFor(const DoorAsset& door, std::uint64_t seed = 1) {
  return PlaceRobotBase(FlyingHand(), SampleScene(door, seed, 0, FlyingScene()), door);
}

Eigen::Vector3d Clipped(const Eigen::Vector3d& v, double most) {
  const double length = v.norm();
  return length > most ? Eigen::Vector3d(v * (most / length)) : v;
}

// Goes straight to the grasp, closes, turns the handle about its axis and the leaf about its own.
class Scripted : public HandPolicy {
 public:
  HandCommand Act(const HandState& state, const LabelledCloud& /*cloud*/) override {
    const Eigen::Vector3d way =
        state.world_from_grasp.translation() - state.world_from_tcp.translation();
    const Eigen::Vector3d turn =
        RotationVector(state.world_from_grasp.linear() * state.world_from_tcp.linear().transpose());
    if (!state.closes_fingers && (way.norm() > 0.004 || turn.norm() > 0.05))
      return {Clipped(way, task_.move_m), Clipped(turn, task_.turn_rad), false};
    if (closing_++ < 10) return {Clipped(way, 0.002), Eigen::Vector3d::Zero(), true};
    if (state.locked || (state.hinge_rad < 0.02 && state.handle_rad < state.handle_done_rad))
      return About(state, state.handle_origin_m, state.handle_axis, 0.1);
    return About(state, state.hinge_origin_m, state.hinge_axis, 0.03);
  }
  const HandTaskConfig& task() const override { return task_; }

 private:
  static HandCommand About(const HandState& state, const Eigen::Vector3d& origin,
                           const Eigen::Vector3d& axis, double angle) {
    const Eigen::Vector3d arm = state.world_from_tcp.translation() - origin;
    const Eigen::Vector3d turned = RotationAbout(axis, angle) * arm;
    return {turned - arm, angle * axis, true};
  }

  HandTaskConfig task_;
  int closing_ = 0;
};

TEST(HandStepper, BeginsBeforeTheHandleAndNowhereElse) {
  const DoorAsset door = DoorWith(Mechanism::kLever);
  const HandTaskConfig task;
  HandStepper stepper(door, FlyingHand(), task);
  for (std::uint64_t seed = 1; seed < 8; ++seed) {
    const HandState state = stepper.Reset(SceneFor(door, seed)).state;
    const Eigen::Vector3d tool_in_grasp =
        (state.world_from_grasp.inverse() * state.world_from_tcp).translation();
    EXPECT_NEAR(tool_in_grasp.z(), -task.start_distance_m, task.start_spread_m + 1e-3);
    EXPECT_LT(std::abs(tool_in_grasp.x()), task.start_spread_m + 1e-3);
    EXPECT_LT(std::abs(tool_in_grasp.y()), task.start_spread_m + 1e-3);
    EXPECT_EQ(state.hinge_rad, 0);
    EXPECT_TRUE(state.locked);
    EXPECT_FALSE(stepper.now().over);
  }
}

// A rule of a few lines does the task, with a grip and to 45 degrees: it can be done in the budget.
TEST(HandStepper, IsATaskThatASimpleRuleDoes) {
  for (const Mechanism mechanism : {Mechanism::kNone, Mechanism::kLever}) {
    const DoorAsset door = DoorWith(mechanism);
    Scripted policy;
    const Episode episode = RunHandEpisode(SceneFor(door), door, FlyingHand(), policy, nullptr);
    EXPECT_EQ(episode.outcome, EpisodeOutcome::kOpened) << episode.detail;
    EXPECT_GT(episode.peak_hinge_rad, std::numbers::pi / 4);
    EXPECT_TRUE(episode.handle_turned);
    EXPECT_EQ(episode.grasps, 1);
  }
}

TEST(HandStepper, MovesTheToolByWhatItIsTold) {
  const DoorAsset door = DoorWith(Mechanism::kNone);
  HandStepper stepper(door, FlyingHand(), {});
  const RigidTransform before = stepper.Reset(SceneFor(door)).state.world_from_tcp;
  const HandCommand command{{0.01, 0.015, -0.005}, {0, 0, 0.1}, false};
  const HandState after = stepper.Step(command).state;
  const Eigen::Vector3d moved = after.world_from_tcp.translation() - before.translation();
  // from rest it lags behind by a quarter of the way
  EXPECT_LT((moved - command.move_m).norm(), 0.3 * command.move_m.norm());
  const Eigen::Vector3d turned =
      RotationVector(after.world_from_tcp.linear() * before.linear().transpose());
  EXPECT_LT((turned - command.turn_rad).norm(), 0.4 * command.turn_rad.norm());
}

TEST(HandStepper, GivesTheSameBitsForTheSameCommands) {
  const DoorAsset door = DoorWith(Mechanism::kLever);
  std::string first;
  for (int round = 0; round < 2; ++round) {
    Scripted policy;
    const Episode episode = RunHandEpisode(SceneFor(door), door, FlyingHand(), policy, nullptr);
    if (round == 0) first = episode.state_sha256;
    EXPECT_EQ(episode.state_sha256, first);
  }
}

TEST(HandStepper, SaysWhyAHandThatStaysDidNotOpenTheDoor) {
  const DoorAsset door = DoorWith(Mechanism::kLever);
  HandTaskConfig task;
  task.max_actions = 5;
  HandStepper stepper(door, FlyingHand(), task);
  stepper.Reset(SceneFor(door));
  while (!stepper.now().over) stepper.Step({});
  EXPECT_EQ(stepper.Summary().outcome, EpisodeOutcome::kNotReached);
  EXPECT_THROW(stepper.Step({}), Error);
}

// Learning goes on to the budget, whatever was reached.
TEST(HandStepper, GoesOnToTheBudgetWhereThatIsAsked) {
  const DoorAsset door = DoorWith(Mechanism::kNone);
  Scripted policy;
  HandStepper stepper(door, FlyingHand(), policy.task(), HandEpisodeEnd::kBudget);
  stepper.Reset(SceneFor(door));
  int actions = 0;
  bool opened = false;
  for (; !stepper.now().over; ++actions) {
    const HandState& state = stepper.now().state;
    stepper.Step(state.hinge_rad > 0.9 ? HandCommand{{}, {}, true} : policy.Act(state, {}));
    opened = opened || stepper.now().opened;
  }
  EXPECT_TRUE(opened);
  EXPECT_EQ(actions, policy.task().max_actions);
}

void ExpectRefused(const std::function<void()>& call, ErrorCode code, const std::string& word) {
  try {
    call();
    ADD_FAILURE() << "not refused: " << word;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

// Looking changes nothing of what happens.
TEST(HandStepper, LooksOnRequestThroughItsObserver) {
  class Counting : public Observer {
   public:
    LabelledCloud Observe(const SceneSnapshot& /*snapshot*/) override {
      ++looks;
      return {{1, 2, 3}, {0}};
    }
    int looks = 0;
  };
  const DoorAsset door = DoorWith(Mechanism::kNone);
  const Scene scene = SceneFor(door);
  HandStepper stepper(door, FlyingHand(), {});
  EXPECT_THROW(stepper.Look(), Error);
  stepper.Reset(scene);
  EXPECT_TRUE(stepper.Look().xyz.empty());  // nobody sees
  stepper.Step({});
  const std::string blind = stepper.Summary().state_sha256;
  Counting observer;
  stepper.Reset(scene, &observer);
  EXPECT_EQ(stepper.Look().xyz.size(), 3U);
  stepper.Step({});
  EXPECT_EQ(observer.looks, 1);
  EXPECT_EQ(stepper.Summary().state_sha256, blind);
  Scripted knows;
  RunHandEpisode(scene, door, FlyingHand(), knows, &observer);
  EXPECT_EQ(observer.looks, 1);  // who asks for no look is shown none
}

TEST(HandStepper, RefusesWhatItCannotPlay) {
  const DoorAsset door = DoorWith(Mechanism::kNone);
  const RobotModel arm = LoadMobileFranka();
  ExpectRefused([&] { HandStepper(door, arm, {}); }, ErrorCode::kInvalidConfig,
                "scene.physics.base: sliders, where a hand that flies");
  HandTaskConfig task;
  task.move_m = 3;
  ExpectRefused([&] { HandStepper(door, FlyingHand(), task); }, ErrorCode::kInvalidConfig,
                "task.move_m");
  HandStepper stepper(door, FlyingHand(), {});
  ExpectRefused([&] { stepper.Step({}); }, ErrorCode::kInvalidArgument, "Reset()");
  stepper.Reset(SceneFor(door));
  HandCommand command;
  command.move_m.x() = std::numeric_limits<double>::quiet_NaN();
  ExpectRefused([&] { stepper.Step(command); }, ErrorCode::kInvalidArgument, "finite");
}

}  // namespace
}  // namespace doorforge
