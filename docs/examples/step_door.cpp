// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Opens a door that was composed before step by step, and tries three ways on from one grasp:
//
//   doorforge compose --body interior_flush_01 --handle interior_lever_tube_01 --out door
//   step_door door

#include <cstdio>

#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/episode_stepper.h"

// Leads the hand on a circle about the hinge, `lead_rad` ahead of where it is.
doorforge::Action OnTheCircle(const doorforge::Observation& seen, double lead_rad) {
  const doorforge::PrivilegedState& state = seen.privileged;
  const auto turn = doorforge::RotationAbout(state.hinge_axis_in_world, lead_rad);
  const Eigen::Vector3d hand = state.world_from_hand.translation();
  const Eigen::Vector3d arm = hand - state.hinge_origin_in_world;
  return {turn.linear() * arm - arm, turn.linear() * state.world_from_hand.linear()};
}

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: step_door DOOR\n"), 2;
  const doorforge::DoorAsset door = doorforge::ReadDoor(argv[1]);
  const doorforge::RobotModel robot = doorforge::LoadMobileFranka();
  doorforge::EpisodeStepper stepper(door, robot);
  stepper.Reset(doorforge::SampleScene(door, /*seed=*/7, /*episode=*/0));  // grasps and unlocks
  const doorforge::EpisodeImage held = stepper.Save();
  int opened = 0;
  for (const double lead_rad : {0.0, 0.04, 0.08}) {
    stepper.Restore(held);
    double gained_rad = 0;
    while (!stepper.now().over())
      gained_rad += stepper.Step(OnTheCircle(stepper.now().observation, lead_rad)).reward;
    const doorforge::StepResult& end = stepper.now();
    opened += end.cause == doorforge::EpisodeOutcome::kOpened ? 1 : 0;
    std::printf("%.2f rad ahead: %s%s, hinge gained %.0f degrees\n", lead_rad,
                end.cause ? std::string(NameOf(*end.cause)).c_str() : "not over",
                end.truncated ? " when the actions were used up" : "", gained_rad * 57.29577951);
  }
  return opened > 0 ? 0 : 1;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "step_door: %s\n", error.what()), 3;
}
