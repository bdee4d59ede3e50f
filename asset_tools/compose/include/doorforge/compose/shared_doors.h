// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "doorforge/compose/compose.h"
#include "doorforge/core/committed_file.h"

namespace doorforge {

/// Writes the meshes and shapes of the parts into `doors`/pool, see mesh_pool.h. What is there
/// already is compared and kept; a file that differs from what its name says is replaced. The same
/// bytes for any number of threads.
void WriteMeshPool(std::span<const PreparedPart> parts, const std::filesystem::path& doors,
                   int threads);

/// What became of one pair.
struct SharedDoorOutcome {
  std::string id;
  bool kept = false;    ///< It was there already with the same content.
  std::string problem;  ///< Empty if the door is there; else the rule that refuses it, or why not.
};

/// A body and a handle by their places among the parts.
struct PartPair {
  std::size_t body;
  std::size_t handle;
  std::optional<RigidTransform> body_from_handle = {};  ///< ComposeDoor() takes the same.
};

/// What to write, and how.
struct SharedDoorPlan {
  std::span<const PreparedPart> parts;
  std::span<const PartPair> pairs;
  ComposeConfig config;
  Existing existing = Existing::kRefuse;  ///< kReplace also replaces doors of other content.
  int threads = 0;                        ///< 0: all processors. Does not change any byte.
};

/// Composes the pairs into `doors`/<id>/{door.json, model.urdf}, beside the pool. Doors that are
/// there with the same content are kept, so a run that was ended goes on where it was. Outcomes are
/// in the order of the pairs; pairs that a StopRequested() left out say so.
///
/// @param progress Called after each batch with the number of pairs done.
std::vector<SharedDoorOutcome> WriteSharedDoors(const SharedDoorPlan& plan,
                                                const std::filesystem::path& doors,
                                                const std::function<void(std::size_t)>& progress);

}  // namespace doorforge
