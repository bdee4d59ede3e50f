// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "doorforge/reinforce/train_ppo.h"
#include "doorforge/reinforce/trajectory_task.h"

namespace doorforge {

/// The word for it in the records of policies.
inline constexpr const char* kTrajectoryMethod = "trajectories";

/// A training of a policy that says whole trajectories, from doors to its folder.
struct TrajectoryTrainingRequest : HandTrainingRequest {
  TrajectoryTrainingConfig config;
  std::optional<int> rounds = {};  ///< In the place of config.learning.rounds.
};

struct TrajectoryTrainingOutcome {
  std::vector<std::string> notes;  ///< On the doors, see DoorSet.
  std::size_t doors = 0;
  int rounds_done = 0;
  int rounds_total = 0;
  TrajectoryRound last = {};  ///< The last round, where one is done.

  bool finished() const { return rounds_done >= rounds_total; }
};

/// Trains and shows progress. After each round it writes the samples that it added
/// (samples/round_<n>.safetensors), the policy (see WriteTrajectoryPolicy()), the curves and the
/// state that `resume` reads, so that a kill loses one round at most; once, config.yaml.
///
/// @throws Error(kInvalidArgument) if `out` holds a training and neither `resume` nor `overwrite`
///     says what to do; else as FindDoorSet(), TrajectoryLessons(), ReadTrajectoryState(),
///     ReadTrajectorySamples(), TrainTrajectories().
TrajectoryTrainingOutcome TrainTrajectoriesIntoFolder(TrajectoryTrainingRequest request);

/// What came of a training, for people; of one that is not finished, how to go on.
std::string OutcomeText(const TrajectoryTrainingOutcome& outcome,
                        const TrajectoryTrainingRequest& request);

}  // namespace doorforge
