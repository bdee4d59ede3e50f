// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/reinforce/door_task.h"

namespace doorforge {

/// The word for it among the stages of `doorforge train`.
inline constexpr const char* kPpoMethod = "ppo";

/// What a training of a hand is asked for, whatever it learns from.
struct HandTrainingRequest {
  /// Words of --doors: folders, and at most one split, of which the training side is the default.
  std::vector<std::string> doors;
  std::filesystem::path out;
  std::optional<std::uint64_t> seed = {};  ///< In the place of the config's.
  double minutes = 0;      ///< Ends after the last update or round within this time; 0: never.
  int threads = 0;         ///< 0: all processors; the result does not depend on it.
  bool resume = false;     ///< Goes on from the state in `out`, if there is one.
  bool overwrite = false;  ///< Starts anew where `out` holds a training.
};

/// A training by trying, from doors to a policy's folder.
struct PpoTrainingRequest : HandTrainingRequest {
  HandTrainingConfig config;
  /// A folder that DistilIntoFolder() wrote, whose network's features are what the hand acts on;
  /// empty: it acts on true states.
  std::filesystem::path features = {};
  std::optional<std::uint64_t> decisions = {};  ///< In the place of config.ppo.decisions.
};

struct PpoTrainingOutcome {
  std::vector<std::string> notes;  ///< On the doors, see DoorSet.
  std::size_t doors = 0;
  std::uint64_t updates_done = 0;
  std::uint64_t updates_total = 0;
  PpoUpdate last = {};  ///< The last update, where one is done.

  bool finished() const { return updates_done >= updates_total; }
};

/// Trains and shows progress. After each update it writes the state that `resume` reads, the policy
/// (policy.json, policy.safetensors, see WriteHandPolicy() and WriteFrozenPolicy()), the curves
/// (losses.jsonl, training.html, an event file) and, once, config.yaml, so that a kill loses one
/// update at most.
///
/// @throws Error(kMissing) if `features` is no folder; Error(kInvalidArgument) if `out` holds a
///     training and neither `resume` nor `overwrite` says what to do; else as ReadSightPolicy(),
///     FindDoorSet(), DoorTask(), ReadPpoState() and TrainPpo().
PpoTrainingOutcome TrainPpoIntoFolder(PpoTrainingRequest request);

/// What came of a training, for people; of one that is not finished, how to go on.
std::string OutcomeText(const PpoTrainingOutcome& outcome, const PpoTrainingRequest& request);

}  // namespace doorforge
