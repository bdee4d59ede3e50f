// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Lets a policy of one's own open a door that was composed before:
//
//   doorforge compose --body interior_flush_01 --handle interior_lever_tube_01 --out door
//   own_policy door
//
// The expert grasps and unlocks; from there on the policy says every 1/6 s where the hand goes
// next.

#include <cstdio>

#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/run_episode.h"

// Leads the hand on a circle about the hinge, a little ahead of where it is.
class CircleAboutHinge : public doorforge::Policy {
 public:
  doorforge::Action Act(const doorforge::Observation& seen) override {
    constexpr double kLeadRad = 0.08;
    const doorforge::PrivilegedState& state = seen.privileged;  // a trained policy reads seen.cloud
    const auto turn = doorforge::RotationAbout(state.hinge_axis_in_world, kLeadRad);
    const Eigen::Vector3d hand = state.world_from_hand.translation();
    const Eigen::Vector3d arm = hand - state.hinge_origin_in_world;
    return {turn.linear() * arm - arm, turn.linear() * state.world_from_hand.linear()};
  }
};

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: own_policy DOOR\n"), 2;
  const doorforge::DoorAsset door = doorforge::ReadDoor(argv[1]);
  const doorforge::RobotModel robot = doorforge::LoadMobileFranka();
  CircleAboutHinge policy;
  int opened = 0;
  for (std::uint64_t episode = 0; episode < 5; ++episode) {
    const doorforge::Scene scene = doorforge::SampleScene(door, /*seed=*/7, episode);
    doorforge::CameraObserver camera(scene, door, robot);
    const auto result = doorforge::RunEpisode(scene, door, robot, policy, &camera);
    opened += result.outcome == doorforge::EpisodeOutcome::kOpened ? 1 : 0;
    std::printf("episode %d: %s, hinge %.0f degrees\n", static_cast<int>(episode),
                std::string(doorforge::NameOf(result.outcome)).c_str(),
                result.peak_hinge_rad * 57.29577951);
  }
  std::printf("opened %d of 5\n", opened);
  return opened > 0 ? 0 : 1;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "own_policy: %s\n", error.what()), 3;
}
