// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/run_episode.h"

#include "doorforge/core/error.h"

#include "episode_run.h"

namespace doorforge {

Episode RunEpisode(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                   Policy& opening, Observer* observer) {
  return RunStages(scene, door, robot, {.open = &opening}, observer);
}

Episode RunStages(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                  const EpisodeRoles& roles, Observer* observer) {
  Require(roles.open != nullptr && (roles.recorded != Stage::kHandle || roles.handle != nullptr) &&
              (roles.recorded != Stage::kGrasp || roles.grasp != nullptr),
          ErrorCode::kInvalidArgument,
          "episode: nobody decides at the stage \"" + std::string(NameOf(roles.recorded)) +
              "\" that is to be recorded, or opens");
  Require(scene.door_id == door.id, ErrorCode::kInvalidArgument,
          "the scene is of door \"" + scene.door_id + "\", not of \"" + door.id + '"');
  const DoorAsset varied = Varied(door, scene.variation);
  internal::EpisodeRun run(scene, varied, robot, roles, observer);
  auto failure = roles.grasp != nullptr ? run.TakeHold(*roles.grasp) : run.TakeHold();
  if (!failure) failure = roles.handle != nullptr ? run.Turn(*roles.handle) : run.Unlock();
  if (!failure) failure = run.Open(*roles.open);
  return run.Finish(failure);
}

}  // namespace doorforge
