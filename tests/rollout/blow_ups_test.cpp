// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Random and adversarial actions with all that the drives give: whatever state a world passes as
// plausible is so by what this test knows by itself, and no action ends more than its own episode.
//
//     DOORFORGE_BLOW_UPS=1000 DOORFORGE_BLOW_UP_DOORS=doors rollout_test --gtest_filter='BlowUps.*'
//
// takes as many doors of a folder of composed doors, one an episode, spread over all of them.

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/physics/hand_controller.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/episode_stepper.h"
#include "doorforge/rollout/grasp_plan.h"
#include "doorforge/schemas/door_set.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

constexpr int kBlowUpSteps = 720;  // 3 s

// What an episode came to.
struct BlownUp {
  std::string end = "whole";  // or what the watch found, or how the episode ended
  int steps = 0;
  double fastest_rad_s = 0;
};

std::size_t WantedEpisodes() {
  const char* wanted = std::getenv("DOORFORGE_BLOW_UPS");
  return wanted == nullptr ? 12 : static_cast<std::size_t>(std::atoi(wanted));
}

// About the hinge [kg m^2].
double LeafInertia(const DoorAsset& door) {
  const MassProperties& leaf = door.links[1].mass;
  const Eigen::Vector3d axis = door.hinge.axis;
  return axis.dot(leaf.inertia_kg_m2 * axis) +
         leaf.mass_kg * leaf.center_of_mass_m.cross(axis).squaredNorm();
}

// Follows a world and knows what its drives can have done at most.
class Bystander {
 public:
  Bystander(const DoorAsset& door, const RobotModel& robot, const WorldState& start)
      : robot_(robot), inertia_(LeafInertia(door)), before_(start.robot_position) {}

  // What is wrong with a state that the watch let pass; empty if nothing is.
  std::string FaultOf(const WorldState& state) {
    const bool finite = state.robot_position.allFinite() && state.robot_velocity.allFinite() &&
                        std::isfinite(state.hinge_rad) && std::isfinite(state.hinge_rad_s) &&
                        std::isfinite(state.handle_rad) && std::isfinite(state.handle_rad_s);
    if (!finite) return "a number is not finite";
    for (std::size_t i = 0; i < robot_.joints().size(); ++i) {
      const RobotJoint& joint = robot_.joints()[i];
      const double position = state.robot_position[static_cast<Eigen::Index>(i)];
      const double beyond = joint.prismatic ? 0.05 : 0.6;
      if (position < joint.lower - beyond || position > joint.upper + beyond)
        return joint.name + " stands at " + std::to_string(position);
      work_j_ += joint.effort * std::abs(position - before_[static_cast<Eigen::Index>(i)]);
    }
    before_ = state.robot_position;
    const double motion_j = 0.5 * inertia_ * state.hinge_rad_s * state.hinge_rad_s;
    if (motion_j > work_j_ + 10)  // springs and what pushes overlapping shapes apart hold less
      return "the leaf has " + std::to_string(motion_j) + " J of " + std::to_string(work_j_);
    return "";
  }

 private:
  const RobotModel& robot_;
  double inertia_;
  JointVector before_;
  double work_j_ = 0;
};

RigidTransform AnyPose(const RigidTransform& about, double reach, Rng& rng) {
  RigidTransform pose = about;
  pose.translation() +=
      Eigen::Vector3d(rng.Uniform(-reach, reach), rng.Uniform(-reach, reach), rng.Uniform(-1, 1));
  const Eigen::Vector3d axis(rng.Normal(), rng.Normal(), rng.Normal());
  pose.linear() = Eigen::AngleAxisd(rng.Uniform(-3.1, 3.1), axis.normalized()).matrix();
  return pose;
}

// Joints are asked for where they are not, up to where they cannot be, so that drives give all they
// have for as long as this goes on.
class Adversary {
 public:
  Adversary(const RobotModel& robot, bool pumps, Rng& rng)
      : robot_(robot), pumps_(pumps), rng_(rng), boldness_(rng.Uniform(-2, 1)) {}

  RobotCommand Command(const WorldState& state) {
    if (left_-- <= 0) Turn();
    RobotCommand command;
    command.close_fingers = closes_;
    const auto drives = static_cast<Eigen::Index>(robot_.joints().size()) - 2;
    command.arm_position = ArmVector::Zero(drives);
    for (Eigen::Index i = 0; i < drives; ++i) {
      const double along = state.robot_velocity[i] < 0 ? -1 : 1;
      const double way = pumps_ ? along : way_.at(static_cast<std::size_t>(i));
      command.arm_position[i] = state.robot_position[i] + lead_ * way;
    }
    if (robot_from_tcp_) command.world_from_tcp = robot_from_tcp_;
    return command;
  }

  void DriveHand(const RigidTransform& about) { about_ = about; }

 private:
  void Turn() {
    left_ = 1 + static_cast<int>(rng_.Index(60));
    closes_ = rng_.Uniform() < 0.7;
    lead_ = std::pow(10, rng_.Uniform(-3, boldness_));
    for (double& way : way_) way = rng_.Uniform() < 0.5 ? -1 : 1;
    if (about_) robot_from_tcp_ = AnyPose(*about_, 3, rng_);
  }

  const RobotModel& robot_;
  bool pumps_;
  Rng& rng_;
  double boldness_;  // of the largest lead the decimal logarithm: many of these episodes go on
  int left_ = 0;
  bool closes_ = false;
  double lead_ = 0;  // [rad or m]
  std::array<double, kMostArmJoints> way_{};
  std::optional<RigidTransform> about_;
  std::optional<RigidTransform> robot_from_tcp_;
};

// Torques on a world, from a hand on the handle or from where the robot rests.
BlownUp RunTorques(const IdentifiedDoor& door, const RobotModel& robot, std::uint64_t number) {
  Rng rng(31, "blow_ups/" + std::to_string(number));
  SceneConfig config;
  const bool by_hand = number % 4 == 2;
  if (by_hand) config.physics.controller = ArmController::kOperationalSpace;
  const Scene scene = SampleScene(door, 31, number, config);
  const GraspPlan plan = PlanGrasp(scene, *door, robot);
  DoorWorld world(scene, *door, robot, rng.Uniform() < 0.7 ? plan.grasp : plan.pregrasp);
  HandController holding(robot, scene.world_from_robot_base, plan.grasp);
  holding.close_fingers = true;
  Adversary adversary(robot, number % 4 == 1, rng);
  if (by_hand) adversary.DriveHand(holding.CommandedHand());
  Bystander bystander(*door, robot, world.state());
  BlownUp result;
  const int quiet = rng.Uniform() < 0.5 ? 0 : 60;  // until the fingers have closed
  for (; result.steps < kBlowUpSteps; ++result.steps) {
    world.Step(result.steps < quiet
                   ? holding.Step(world.state().robot_position, scene.physics.time_step_s)
                   : adversary.Command(world.state()));
    if (world.fault()) {
      result.end = NameOf(world.fault()->kind);
      break;
    }
    const std::string fault = bystander.FaultOf(world.state());
    EXPECT_EQ(fault, "") << door->id << ", episode " << number << ", step " << result.steps;
    if (!fault.empty()) break;
    result.fastest_rad_s = std::max(result.fastest_rad_s, std::abs(world.state().hinge_rad_s));
  }
  return result;
}

// Actions far away, of any rotation, and some that are no numbers, behind the rules' grasp.
BlownUp RunActions(const IdentifiedDoor& door, const RobotModel& robot, std::uint64_t number) {
  Rng rng(31, "blow_ups/" + std::to_string(number));
  const Scene scene = SampleScene(door, 31, number);
  StepperOptions options;
  options.bad_action = BadAction::kDiverge;
  options.first = rng.Uniform() < 0.5 ? Stage::kOpen : Stage::kHandle;
  EpisodeStepper stepper(*door, robot, options);
  stepper.Reset(scene);
  BlownUp result;
  Bystander bystander(*door, robot, stepper.state());
  while (!stepper.now().over()) {
    Action action;
    const RigidTransform pose = AnyPose(RigidTransform::Identity(), 5, rng);
    action.position_delta_m = pose.translation();
    action.world_from_hand_rotation = pose.linear();
    if (rng.Uniform() < 0.02)
      action.position_delta_m.y() = std::numeric_limits<double>::quiet_NaN();
    if (rng.Uniform() < 0.02) action.position_delta_m *= 1e300;
    stepper.Step(action);
    ++result.steps;
    const bool diverged = stepper.now().cause == EpisodeOutcome::kDiverged;
    if (!diverged) {
      EXPECT_EQ(bystander.FaultOf(stepper.state()), "") << door->id << ", episode " << number;
    }
  }
  result.end = stepper.now().cause ? NameOf(*stepper.now().cause) : "truncated";
  return result;
}

double ProcessorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

TEST(BlowUps, NoActionAtFullTorqueEscapesTheWatchOrStopsTheBatch) {
  const std::size_t episodes = WantedEpisodes();
  const char* folder = std::getenv("DOORFORGE_BLOW_UP_DOORS");
  std::vector<FoundDoor> found;
  if (folder != nullptr) found = FindDoorSet({.folders = {folder}}, 1).doors;
  DoorCache shelf(found);
  const RobotModel robot = LoadMobileFranka();
  const double began = ProcessorSeconds();
  std::map<std::string, int> ends;
  double fastest = 0;
  long steps = 0;
  for (std::size_t i = 0; i < episodes; ++i) {
    const auto door = [&]() -> IdentifiedDoor {
      if (folder != nullptr) return shelf.Take(i * found.size() / episodes);
      const Mechanism mechanism = i % 3 == 0 ? Mechanism::kRound : Mechanism::kLever;
      const auto made =
          std::make_shared<const DoorAsset>(MakePrimitiveDoor(RandomPrimitive(mechanism, 31, i)));
      return {made, ContentHash(*made)};
    };
    try {
      const BlownUp result =
          i % 4 == 3 ? RunActions(door(), robot, i) : RunTorques(door(), robot, i);
      ++ends[result.end];
      steps += result.steps;
      fastest = std::max(fastest, result.fastest_rad_s);
    } catch (const std::exception& error) {
      ADD_FAILURE() << "episode " << i << " would have stopped a batch: " << error.what();
    }
  }
  std::printf("%zu episodes, %ld steps and actions, leaf at most %.1f rad/s, %.0f s;", episodes,
              steps, fastest, ProcessorSeconds() - began);
  for (const auto& [end, count] : ends) std::printf(" %s %d", end.c_str(), count);
  std::printf("\n");
}

}  // namespace
}  // namespace doorforge
