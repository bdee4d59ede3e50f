// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "doorforge/schemas/episode_memory.h"
#include "doorforge/schemas/grasp_policy.h"
#include "doorforge/schemas/hand_policy.h"
#include "doorforge/schemas/policy.h"
#include "doorforge/schemas/stage_switch.h"

namespace doorforge {

/// Who acts at each stage of an episode. One set serves one episode at a time.
struct PolicySet {
  std::unique_ptr<Policy> open;              ///< Never null where an episode is run.
  std::unique_ptr<Policy> handle = nullptr;  ///< Null: the expert's rule turns it in one go.
  /// Says when the handle is turned, such as `handle` itself; null: the simulator does.
  StageSwitch* handle_turned = nullptr;
  std::unique_ptr<GraspPolicy> grasp = nullptr;  ///< Null: the expert's grasp.
  /// Pixels along each side of the camera that `grasp` looks through, times those of the scene's.
  int grasp_resolution_scale = 1;
  int grasps = 1;  ///< So many times the hand may take hold in an episode.
  std::shared_ptr<EpisodeMemory> memory = nullptr;  ///< The policies share it; null: nothing.
  /// Does all of an episode by itself, from before the handle on; then none of the others acts.
  std::unique_ptr<HandPolicy> whole = nullptr;
};

}  // namespace doorforge
