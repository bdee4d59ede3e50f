// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "doorforge/physics/scene_sampling.h"
#include "doorforge/schemas/door_identity.h"

namespace doorforge {

/// Which episode of a door.
struct SightRequest {
  std::uint64_t seed = 1;
  std::uint64_t episode = 0;
  bool all_decisions = false;  ///< False: the first of each stage alone.
  SceneConfig scene;
};

/// What was written.
struct RecordedSight {
  int handle_decisions = 0;  ///< 0: the door needs no turn of its handle.
  int open_decisions = 0;
};

/// Writes what a real robot would be given in an episode that rules decide, in the files that
/// docs/act.md describes:
///
///   grasp/depth.png, mask.png, camera.yaml     the closed door before the robot is in view
///   handle/depth.png, state.yaml, camera.yaml  the hand holds the handle, which is to be turned
///   open/depth.png, state.yaml, camera.yaml    the door is unlocked
///
/// With `all_decisions` further pictures follow as depth_001.png and state_001.yaml, and `lines`
/// has a line for each decision that `doorforge act --stream` reads. Equal arguments give equal
/// files.
///
/// @throws Error(kInvalidArgument) if the rules do not come to opening the door in this episode,
///     and as SampleScene(), CameraObserver; Error(kIo) as CommitFile().
RecordedSight RecordSight(const IdentifiedDoor& door, const SightRequest& request,
                          const std::filesystem::path& folder);

}  // namespace doorforge
