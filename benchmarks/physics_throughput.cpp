// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Steps per second of CPU time with the gripper on a lever, for several solver iterations, against
// the same scene with the arm idle and, where it was found, against MuJoCo on the same scene; and
// decisions a second of a stepper on the state; and whole episodes of each mechanism, without and
// with a camera. One thread; medians of five.

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <unistd.h>

#ifdef DOORFORGE_WITH_MUJOCO
#include <mujoco/mujoco.h>

#include "mujoco_scene.h"
#endif

#include "doorforge/physics/door_world.h"
#include "doorforge/physics/hand_controller.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/episode_stepper.h"
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

constexpr int kRounds = 5;

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Holds the arm where the plan puts it, with the fingers closed on the bar or open.
Rate HoldRate(const Scene& scene, const DoorAsset& door, const RobotModel& robot, bool grasp) {
  const GraspPlan plan = PlanGrasp(scene, door, robot);
  DoorWorld world(scene, door, robot, grasp ? plan.grasp : robot.InitialPosition());
  HandController controller(robot, scene.world_from_robot_base, world.state().robot_position);
  controller.close_fingers = grasp;
  constexpr int kWarmUp = 240;
  constexpr int kSteps = 1200;
  for (int i = 0; i < kWarmUp; ++i)
    world.Step(controller.Step(world.state().robot_position, scene.physics.time_step_s));
  std::vector<double> rates;
  double points = 0;
  for (int round = 0; round < kRounds; ++round) {
    const double start = CpuSeconds();
    for (int i = 0; i < kSteps; ++i)
      world.Step(controller.Step(world.state().robot_position, scene.physics.time_step_s));
    rates.push_back(kSteps / (CpuSeconds() - start));
    const DoorContacts contacts = world.Contacts();
    points += contacts.pad_points[0] + contacts.pad_points[1] + contacts.arm_points;
  }
  return {Median(rates), points / kRounds};
}

#ifdef DOORFORGE_WITH_MUJOCO
// MuJoCo holds as Bullet does: position drives at the plan's joints, 80 N on each finger.
Rate MujocoRate(const Scene& scene, const DoorAsset& door, const RobotModel& robot, int solver) {
  const std::string file = "/tmp/physics_throughput_" + std::to_string(::getpid()) + ".xml";
  std::ofstream(file) << MujocoScene(scene, door, robot);
  std::array<char, 1000> error{};
  mjModel* model = mj_loadXML(file.c_str(), nullptr, error.data(), static_cast<int>(error.size()));
  std::remove(file.c_str());
  if (model == nullptr) {
    std::printf("MuJoCo: %s\n", error.data());
    return {};
  }
  model->opt.solver = solver;
  mjData* data = mj_makeData(model);
  const GraspPlan plan = PlanGrasp(scene, door, robot);
  const int joints = static_cast<int>(robot.joints().size());
  for (int i = 0; i < joints; ++i) {
    const int joint = mj_name2id(model, mjOBJ_JOINT, ("robot" + std::to_string(i)).c_str());
    data->qpos[model->jnt_qposadr[joint]] = plan.grasp[i];
    data->ctrl[i] = i < joints - 2 ? plan.grasp[i] : -scene.physics.finger_force_n;
  }
  constexpr int kSteps = 1200;
  for (int i = 0; i < 240; ++i) mj_step(model, data);
  std::vector<double> rates;
  double contacts = 0;
  for (int round = 0; round < kRounds; ++round) {
    const double start = CpuSeconds();
    for (int i = 0; i < kSteps; ++i) {
      mj_step(model, data);
      contacts += data->ncon;
    }
    rates.push_back(kSteps / (CpuSeconds() - start));
  }
  mj_deleteData(data);
  mj_deleteModel(model);
  return {Median(rates), contacts / (kRounds * kSteps)};
}

void PrintMujoco(const Scene& scene, const DoorAsset& door, const RobotModel& robot, double own) {
  for (const auto& [name, solver] :
       {std::pair("Newton", mjSOL_NEWTON), std::pair("PGS", mjSOL_PGS)}) {
    const Rate rate = MujocoRate(scene, door, robot, solver);
    std::printf(
        "MuJoCo %-6s, at most %d iterations %6.0f steps/s, %.1f contacts/step; ours %.2f of it\n",
        name, scene.physics.solver_iterations, rate.steps_per_s, rate.contacts_per_step,
        own / rate.steps_per_s);
  }
}
#endif

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
#ifdef DOORFORGE_WITH_MUJOCO
    if (iterations == 50)
      PrintMujoco(SampleScene(door, 1, 0, config), door, robot, rate.steps_per_s);
#endif
  }
}

// An episode as a data set records it: 16 looks of 4096 points.
void PrintSeenEpisodes(const RobotModel& robot) {
  std::vector<double> seconds;
  double looks = 0;
  for (std::uint64_t i = 0; i < kRounds; ++i) {
    const DoorAsset door = MakePrimitiveDoor(RandomPrimitive(Mechanism::kLever, 6, i));
    SceneConfig config;
    config.physics.finish_hinge_rad = 1.2;
    config.physics.max_opening_actions = 16;
    const Scene scene = SampleScene(door, 6, i, config);
    OpeningExpert expert;
    const double start = CpuSeconds();
    CameraObserver camera(scene, door, robot);
    const Episode episode = RunEpisode(scene, door, robot, expert, &camera);
    seconds.push_back(CpuSeconds() - start);
    looks += static_cast<double>(episode.decisions.size());
  }
  std::printf("episode with a camera: %.3f CPU s, %.1f observations\n", Median(seconds),
              looks / kRounds);
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

// Decisions of the opening without a camera, as a learner on the state makes them: each episode
// begins behind the same grasp, by Restore(). A lever with both pads on it, 80 ms and 1/6 s long.
void PrintStateDecisions(const RobotModel& robot) {
  const DoorAsset door = MakePrimitiveDoor({});
  for (const int steps : {20, 40}) {
    SceneConfig config;
    config.physics.steps_per_action = steps;
    config.physics.max_opening_actions = 1000;
    EpisodeStepper stepper(door, robot);
    stepper.Reset(SampleScene(door, 1, 0, config));
    const EpisodeImage held = stepper.Save();
    constexpr int kRestores = 200;
    const double restoring = CpuSeconds();
    for (int i = 0; i < kRestores; ++i) stepper.Restore(held);
    const double restore_s = (CpuSeconds() - restoring) / kRestores;
    std::vector<double> rates;
    for (int round = 0; round < kRounds; ++round) {
      int decisions = 0;
      const double start = CpuSeconds();
      for (int episode = 0; episode < 10; ++episode) {
        stepper.Restore(held);
        OpeningExpert expert;
        for (; !stepper.now().over(); ++decisions)
          stepper.Step(expert.Act(stepper.now().observation));
      }
      rates.push_back(decisions / (CpuSeconds() - start));
    }
    std::printf("state decisions of %2d steps (%.0f ms): %5.0f a core second, restore %.2f ms\n",
                steps, 1000 * steps * config.physics.time_step_s, Median(rates), 1000 * restore_s);
  }
}

}  // namespace
}  // namespace doorforge

int main() {
  const doorforge::RobotModel robot = doorforge::LoadMobileFranka();
  doorforge::PrintSteps(robot);
  doorforge::PrintStateDecisions(robot);
  doorforge::PrintSeenEpisodes(robot);
  doorforge::PrintEpisodes(robot);
}
