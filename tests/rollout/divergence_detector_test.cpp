// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Blow-ups are put into worlds in which the gripper holds or turns a handle, and must be found;
// good episodes must not be accused. Short here; DOORFORGE_LONG_TESTS=1 injects 1,000 and, with
// DOORFORGE_DOORS=<folder of doors>, lets the expert open 5,000.
#include "doorforge/physics/divergence_detector.h"

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <mutex>

#include <gtest/gtest.h>

#include "doorforge/core/parallel_for.h"
#include "doorforge/core/rng.h"
#include "doorforge/physics/door_world.h"
#include "doorforge/physics/hand_controller.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/grasp_plan.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/run_episode.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

bool LongTests() {
  const char* value = std::getenv("DOORFORGE_LONG_TESTS");
  return value != nullptr && std::string(value) == "1";
}

enum class BlowUp {
  kNanState,
  kInfiniteState,
  kNanCommand,
  kArmKick,
  kBaseKick,
  kFingerKick,
  kHingeKick,
  kHandleKick,
  kPenetration,
  kBeyondLimit,
  kHugePush,
  kHugeTurn,
  kCount,
};

double LogUniform(double low, double high, Rng& rng) {
  return low * std::pow(high / low, rng.Uniform(0, 1));
}

double Sign(Rng& rng) { return rng.Uniform(0, 1) < 0.5 ? -1 : 1; }

double& AnyNumber(WorldState& state, Rng& rng) {
  const auto joints = static_cast<std::size_t>(state.robot_position.size());
  const std::size_t at = rng.Index(2 * joints + 4);
  if (at < joints) return state.robot_position[static_cast<Eigen::Index>(at)];
  if (at < 2 * joints) return state.robot_velocity[static_cast<Eigen::Index>(at - joints)];
  const std::array<double*, 4> door = {&state.hinge_rad, &state.hinge_rad_s, &state.handle_rad,
                                       &state.handle_rad_s};
  return *door.at(at - 2 * joints);
}

// A world in which the gripper holds the handle, a random while after it has closed.
struct HeldDoor {
  explicit HeldDoor(std::uint64_t index, const RobotModel& the_robot)
      : robot(the_robot),
        rng(77, "blow_up/" + std::to_string(index)),
        door(MakePrimitiveDoor(
            RandomPrimitive(index % 3 == 0 ? Mechanism::kRound : Mechanism::kLever, 77, index))),
        scene(SampleScene(door, 77, index)),
        plan(PlanGrasp(scene, door, robot)),
        world(scene, door, robot, plan.grasp),
        controller(robot, scene.world_from_robot_base, plan.grasp) {
    controller.close_fingers = true;
    const int steps = 30 + static_cast<int>(rng.Index(60));
    for (int i = 0; i < steps; ++i) Step();
  }

  void Step() { world.Step(Command()); }
  RobotCommand Command() {
    return controller.Step(world.state().robot_position, scene.physics.time_step_s);
  }

  const RobotModel& robot;
  Rng rng;
  DoorAsset door;
  Scene scene;
  GraspPlan plan;
  DoorWorld world;
  HandController controller;
};

void Kick(HeldDoor& held, Eigen::Index joint, double speed) {
  WorldState state = held.world.state();
  state.robot_velocity[joint] += speed;
  held.world.Place(state);
}

void PushIntoTheDoor(HeldDoor& held) {
  WorldState state = held.world.state();
  // the robot looks along its own x; a hand is 6 cm thick and a leaf 4 cm
  const double way = held.rng.Uniform(0.06, 0.12);
  const Eigen::Vector3d forward = held.scene.world_from_robot_base.linear().col(0);
  state.robot_position[0] += forward.x() < 0 ? way : -way;
  held.world.Place(state);
}

void PlaceBeyondLimit(HeldDoor& held) {
  WorldState state = held.world.state();
  const auto arm = held.robot.joints().size() - 2;
  const auto joint = static_cast<std::size_t>(held.rng.Index(arm + 2));
  const double beyond = LogUniform(0.6, 3, held.rng);
  if (joint < arm) {
    state.robot_position[static_cast<Eigen::Index>(joint)] =
        held.robot.joints()[joint].upper + beyond;
  } else {
    (joint == arm ? state.hinge_rad : state.handle_rad) = -beyond;
  }
  held.world.Place(state);
}

void Inject(BlowUp kind, HeldDoor& held) {
  Rng& rng = held.rng;
  WorldState state = held.world.state();
  const auto joints = held.robot.joints().size();
  switch (kind) {
    case BlowUp::kNanState:
      AnyNumber(state, rng) = std::numeric_limits<double>::quiet_NaN();
      return held.world.Place(state);
    case BlowUp::kInfiniteState:
      AnyNumber(state, rng) = Sign(rng) * std::numeric_limits<double>::infinity();
      return held.world.Place(state);
    case BlowUp::kNanCommand: {
      RobotCommand command = held.Command();
      command.arm_position[static_cast<Eigen::Index>(rng.Index(joints - 2))] = std::nan("");
      return held.world.Step(command);
    }
    case BlowUp::kArmKick:
      return Kick(held, static_cast<Eigen::Index>(2 + rng.Index(joints - 4)),
                  Sign(rng) * LogUniform(25, 200, rng));
    case BlowUp::kBaseKick:
      return Kick(held, static_cast<Eigen::Index>(rng.Index(2)),
                  Sign(rng) * LogUniform(1, 50, rng));
    case BlowUp::kFingerKick:
      return Kick(held, static_cast<Eigen::Index>(joints - 2 + rng.Index(2)),
                  Sign(rng) * LogUniform(12, 100, rng));
    case BlowUp::kHingeKick:
      state.hinge_rad_s += Sign(rng) * LogUniform(8, 200, rng);
      return held.world.Place(state);
    case BlowUp::kHandleKick:
      state.handle_rad_s += Sign(rng) * LogUniform(120, 2000, rng);
      return held.world.Place(state);
    case BlowUp::kPenetration:
      return PushIntoTheDoor(held);
    case BlowUp::kBeyondLimit:
      return PlaceBeyondLimit(held);
    case BlowUp::kHugePush:
      // towards where the joint is free: a stop that bears a load is no blow-up
      return held.world.PushLeaf({0, 0.4, 0}, {LogUniform(1e5, 1e9, rng), 0, 0});
    case BlowUp::kHugeTurn:
      return held.world.TurnHandle(LogUniform(1e3, 1e9, rng));
    case BlowUp::kCount:
      break;
  }
}

TEST(DivergenceDetector, FindsEveryBlowUpWithinTenSteps) {
  const RobotModel robot = LoadMobileFranka();
  const std::size_t count = LongTests() ? 1000 : 48;
  std::mutex mutex;
  std::map<std::string, int> found;
  int most_steps = 0;
  ParallelFor(count, 0, [&](std::size_t i) {
    HeldDoor held(i, robot);
    const auto kind = static_cast<BlowUp>(i % static_cast<std::size_t>(BlowUp::kCount));
    ASSERT_FALSE(held.world.fault()) << i << ": " << Describe(*held.world.fault());
    Inject(kind, held);
    int steps = 0;
    while (!held.world.fault() && steps < 10) {
      held.Step();
      ++steps;
    }
    const std::scoped_lock lock(mutex);
    EXPECT_TRUE(held.world.fault()) << "blow-up " << i << " of kind " << static_cast<int>(kind);
    most_steps = std::max(most_steps, steps);
    if (held.world.fault()) ++found[std::string(NameOf(held.world.fault()->kind))];
  });
  for (const auto& [name, times] : found) std::printf("%-14s %d\n", name.c_str(), times);
  std::printf("%zu blow-ups, found after at most %d steps\n", count, most_steps);
}

std::vector<std::filesystem::path> DoorsOf(const char* folder) {
  std::vector<std::filesystem::path> doors;
  if (folder == nullptr) return doors;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (std::filesystem::exists(entry.path() / "door.json")) doors.push_back(entry.path());
  }
  std::sort(doors.begin(), doors.end());
  return doors;
}

TEST(DivergenceDetector, AccusesNoGoodEpisode) {
  const RobotModel robot = LoadMobileFranka();
  const auto folders =
      LongTests() ? DoorsOf(std::getenv("DOORFORGE_DOORS")) : std::vector<std::filesystem::path>{};
  const std::size_t count = LongTests() ? 5000 : 24;
  std::atomic<int> opened = 0;
  ParallelFor(count, 0, [&](std::size_t i) {
    constexpr std::array kMechanisms = {Mechanism::kLever, Mechanism::kRound, Mechanism::kNone};
    // a stride that is prime to their number visits doors of all categories
    const DoorAsset door =
        folders.empty()
            ? MakePrimitiveDoor(RandomPrimitive(kMechanisms.at(i % kMechanisms.size()), 501, i))
            : ReadDoor(folders[i * 7919 % folders.size()]);
    OpeningExpert expert;
    const Episode episode = RunEpisode(SampleScene(door, 501, i), door, robot, expert, nullptr);
    EXPECT_NE(episode.outcome, EpisodeOutcome::kDiverged) << door.id << ": " << episode.detail;
    if (episode.outcome == EpisodeOutcome::kOpened) ++opened;
  });
  std::printf("%zu episodes, %d opened\n", count, opened.load());
}

TEST(DivergenceDetector, LetsAnArmOutOfTheDoorInWhichTheSceneBegins) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  JointVector start = PlanGrasp(scene, door, robot).grasp;
  const double inwards = scene.world_from_robot_base.linear()(0, 0) < 0 ? 1 : -1;
  start[0] += 0.07 * inwards;
  DoorWorld world(scene, door, robot, start);
  HandController controller(robot, scene.world_from_robot_base, start);
  for (int i = 0; i < 20; ++i)
    world.Step(controller.Step(world.state().robot_position, scene.physics.time_step_s));
  EXPECT_TRUE(!world.fault() || world.fault()->time_s > 0.01) << Describe(*world.fault());
}

class NanPolicy final : public Policy {
 public:
  void Reset() override {}
  Action Act(const Observation&) override {
    return {Eigen::Vector3d::Constant(std::nan("")), Eigen::Matrix3d::Identity()};
  }
};

TEST(DivergenceDetector, ABlowUpIsAnOutcomeThatSaysWhatWasFound) {
  const DoorAsset door = MakePrimitiveDoor(RandomPrimitive(Mechanism::kNone, 5, 1));
  NanPolicy policy;
  const RobotModel robot = LoadMobileFranka();
  const Episode episode = RunEpisode(SampleScene(door, 5, 1), door, robot, policy, nullptr);
  EXPECT_EQ(episode.outcome, EpisodeOutcome::kDiverged);
  EXPECT_NE(episode.detail.find("not_finite"), std::string::npos) << episode.detail;
}

DivergenceDetector WatchOfOneJoint() { return DivergenceDetector({{"hinge", false, 0, 1.5, 20}}); }

TEST(DivergenceDetector, AddsUpEnergyThatNothingAccountsFor) {
  DivergenceDetector watch = WatchOfOneJoint();
  WatchedStep step{{0.5}, {1.0}, 0, 0, 0, 0};
  std::optional<StateFault> fault;
  int steps = 0;
  // 0.3 J a step out of nothing, while the drive could have given 0.1 J
  for (; steps < 50 && !fault; ++steps) {
    step.kinetic_j += 0.3;
    step.work_j = 0.1;
    fault = watch.Check(step);
  }
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, DivergenceKind::kEnergyGain);
  EXPECT_NEAR(steps, DivergenceLimits{}.energy_j / 0.2, 2);
}

TEST(DivergenceDetector, EnergyThatWasPutInIsNoGain) {
  DivergenceDetector watch = WatchOfOneJoint();
  WatchedStep step{{0.5}, {1.0}, 0, 0, 5, 0};
  for (int i = 0; i < 100; ++i) {
    step.kinetic_j += 5;
    EXPECT_FALSE(watch.Check(step));
  }
  EXPECT_EQ(watch.surplus_j(), 0);
}

TEST(DivergenceDetector, AllowsTheOverlapWithWhichTheSceneBegins) {
  DivergenceDetector watch = WatchOfOneJoint();
  WatchedStep step{{0.5}, {0.0}, 0.06, 0, 0, 0};
  EXPECT_FALSE(watch.Check(step));
  step.deepest_m = 0.001;
  EXPECT_FALSE(watch.Check(step));
  step.deepest_m = 0.06;
  const auto fault = watch.Check(step);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->kind, DivergenceKind::kPenetration);
}

}  // namespace
}  // namespace doorforge
