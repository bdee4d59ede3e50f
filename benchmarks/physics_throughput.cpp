// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Steps per second of CPU time with the gripper on a lever, for several solver iterations, against
// the same scene with the arm idle; and whole episodes of each mechanism. One thread.

#include <cstdio>
#include <ctime>

#include "doorforge/physics/door_world.h"
#include "doorforge/physics/hand_controller.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/grasp_plan.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/run_episode.h"

#include "primitive_door.h"

namespace doorforge {
namespace {

double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Rate {
  double steps_per_s;
  double contacts_per_step;
};

// Holds the arm where the plan puts it, with the fingers closed on the bar or open.
Rate HoldRate(const Scene& scene, const DoorAsset& door, const RobotModel& robot, bool grasp) {
  const GraspPlan plan = PlanGrasp(scene, door, robot);
  DoorWorld world(scene, door, robot, grasp ? plan.grasp : robot.InitialPosition());
  HandController controller(robot, scene.world_from_robot_base, world.state().robot_position);
  controller.close_fingers = grasp;
  constexpr int kWarmUp = 240;
  constexpr int kSteps = 4800;
  double start = 0;
  double points = 0;
  for (int i = 0; i < kWarmUp + kSteps; ++i) {
    if (i == kWarmUp) start = CpuSeconds();
    world.Step(controller.Step(world.state().robot_position, scene.physics.time_step_s));
    if (i < kWarmUp || i % 100 != 0) continue;
    const DoorContacts contacts = world.Contacts();
    points += contacts.pad_points[0] + contacts.pad_points[1] + contacts.arm_points;
  }
  return {kSteps / (CpuSeconds() - start), points / (kSteps / 100.0)};
}

void PrintSteps(const RobotModel& robot) {
  const DoorAsset door = MakePrimitiveDoor({});
  SceneConfig config;
  const Rate idle = HoldRate(SampleScene(door, 1, 0, config), door, robot, false);
  std::printf("idle arm            %8.0f steps/s\n", idle.steps_per_s);
  for (const int iterations : {10, 20, 50, 100}) {
    config.physics.solver_iterations = iterations;
    const Rate rate = HoldRate(SampleScene(door, 1, 0, config), door, robot, true);
    std::printf("grasp, %3d iterations %6.0f steps/s, %.1f contacts/step, %.2f of idle\n",
                iterations, rate.steps_per_s, rate.contacts_per_step,
                rate.steps_per_s / idle.steps_per_s);
  }
}

void PrintEpisodes(const RobotModel& robot) {
  constexpr int kEpisodes = 20;
  for (const Mechanism mechanism : {Mechanism::kLever, Mechanism::kRound, Mechanism::kNone}) {
    int opened = 0;
    double simulated = 0;
    const double start = CpuSeconds();
    for (int i = 0; i < kEpisodes; ++i) {
      const auto index = static_cast<std::uint64_t>(i);
      const DoorAsset door = MakePrimitiveDoor(RandomPrimitive(mechanism, 5, index));
      OpeningExpert expert;
      const Episode episode = RunEpisode(SampleScene(door, 5, index), door, robot, expert, nullptr);
      opened += episode.outcome == EpisodeOutcome::kOpened ? 1 : 0;
      simulated += episode.simulated_s;
    }
    const double seconds = CpuSeconds() - start;
    std::printf(
        "episode, %-6s %.3f CPU s, %.1f s simulated (%.0f times real time), %d of %d opened\n",
        std::string(NameOf(mechanism)).c_str(), seconds / kEpisodes, simulated / kEpisodes,
        simulated / seconds, opened, kEpisodes);
  }
}

}  // namespace
}  // namespace doorforge

int main() {
  const doorforge::RobotModel robot = doorforge::LoadMobileFranka();
  doorforge::PrintSteps(robot);
  doorforge::PrintEpisodes(robot);
}
