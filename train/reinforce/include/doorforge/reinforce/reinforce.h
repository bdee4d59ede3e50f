// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "doorforge/core/environment_preset.h"
#include "doorforge/reinforce/train_ppo.h"

namespace doorforge {

/// What `doorforge reinforce` was asked for.
struct ReinforceRequest : HandTrainingRequest {
  std::filesystem::path teacher;                ///< Not empty: a hand that looks learns from it.
  std::filesystem::path features;               ///< Not empty: one tries that acts on them.
  bool trajectories = false;                    ///< An arm learns to say whole trajectories.
  std::optional<std::uint64_t> decisions = {};  ///< By trying alone.
  std::optional<int> rounds = {};               ///< Not by trying.
};

struct ReinforceOutcome {
  std::string text;
  bool finished = false;
};

/// TrainPpoIntoFolder(); DistilIntoFolder() where there is a teacher; TrainTrajectoriesIntoFolder()
/// for trajectories.
///
/// @param sources Settings of a HandTrainingConfig, a DistilConfig or a TrajectoryTrainingConfig.
/// @throws Error(kInvalidArgument) where an option is not of this training; as LoadConfig().
ReinforceOutcome Reinforce(const ReinforceRequest& request, const ConfigSources& sources);

}  // namespace doorforge
