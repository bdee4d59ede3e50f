// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/reinforce/distil_task.h"
#include "doorforge/reinforce/train_ppo.h"

namespace doorforge {

/// The word for it in the records of policies.
inline constexpr const char* kDistilMethod = "dagger";

/// A training of a hand that looks, by cloning and DAgger, from a teacher and doors to a policy's
/// folder.
struct DistilRequest : HandTrainingRequest {
  std::filesystem::path teacher;  ///< A folder that TrainPpoIntoFolder() wrote.
  DistilConfig config;
  std::optional<int> rounds = {};  ///< In the place of config.dagger.rounds.
};

struct DistilOutcome {
  std::vector<std::string> notes;  ///< On the doors, see DoorSet.
  std::size_t doors = 0;
  int rounds_done = 0;
  int rounds_total = 0;
  DaggerRound last = {};  ///< The last round, where one is done.

  bool finished() const { return rounds_done >= rounds_total; }
};

/// Trains and shows progress. After each round it writes the samples that it added
/// (samples/round_<n>.safetensors), the policy (see WriteSightPolicy()), the curves and the state
/// that `resume` reads, so that a kill loses one round at most; once, config.yaml.
///
/// @throws Error(kMissing) if `teacher` is no folder of a policy; Error(kFormat) as
///     ReadHandPolicy(), also for a policy that looks itself; Error(kInvalidArgument) if the
///     teacher was trained in another environment (its record's `scene`, but for the camera
///     and what counts as open), naming
///     what differs, or if `out` holds a training and neither `resume` nor `overwrite` says what to
///     do; else as FindDoorSet(), DistilTask(), ReadDistilState(), ReadDistilSamples(),
///     TrainDagger().
DistilOutcome DistilIntoFolder(DistilRequest request);

/// What came of a training, for people; of one that is not finished, how to go on.
std::string OutcomeText(const DistilOutcome& outcome, const DistilRequest& request);

}  // namespace doorforge
