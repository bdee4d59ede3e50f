// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "doorforge/rollout/remembered_view.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/episode.h"

namespace doorforge {

/// A trained policy that acts at a stage instead of the rule, by what its folder says.
struct TrainedPolicy {
  Stage stage = Stage::kOpen;
  std::filesystem::path folder;
  DatasetPolicy identity;
  std::string role;      ///< handler, opener or learner, as its option is called.
  int cloud_points = 0;  ///< It takes clouds of so many; 0: its record does not say.
  RememberedViewConfig remembered{.resolution_scale =
                                      0};  ///< At the stage "handle" it remembers this.
};

/// Reads the record and checks the weights against it, so that a policy that does not fit is
/// refused before any work.
///
/// @throws Error(kMissing) if there is no policy, Error(kFormat) if it is of another schema or its
///     weights are others than the record's, Error(kInvalidArgument) if it is of another stage.
TrainedPolicy ReadTrainedPolicy(const std::filesystem::path& folder, Stage stage,
                                const std::string& role);

/// A line for config.yaml, so that a policy that has changed is noticed when a run goes on.
std::string TrainedPolicyText(const TrainedPolicy& policy);

/// What the policies' bytes depend on beside their folders: the instruction set of the networks'
/// loops.
std::string InferenceKernelName();

}  // namespace doorforge
