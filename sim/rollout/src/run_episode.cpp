// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/run_episode.h"

#include "doorforge/core/error.h"

#include "episode_run.h"

namespace doorforge {

Episode RunEpisode(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                   Policy& opening, Observer* observer) {
  Require(scene.door_id == door.id, ErrorCode::kInvalidArgument,
          "the scene is of door \"" + scene.door_id + "\", not of \"" + door.id + '"');
  const DoorAsset varied = Varied(door, scene.variation);
  internal::EpisodeRun run(scene, varied, robot, observer);
  auto failure = run.Reach();
  if (!failure) failure = run.Grasp();
  if (!failure) failure = run.Unlock();
  if (!failure) failure = run.Open(opening);
  return run.Finish(failure);
}

}  // namespace doorforge
