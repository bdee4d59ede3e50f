// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/policy/train_config.h"
#include "doorforge/policy/turned_classifier.h"
#include "doorforge/training/train_stage.h"

namespace doorforge {

/// A training from data sets to a policy's folder.
struct TrainingRequest {
  std::string stage;  ///< "open", "handle", "grasp", "motion" or "find".
  std::vector<std::filesystem::path> data;
  /// A policy whose weights and normalisation the training begins with; empty: drawn from the seed.
  std::filesystem::path from = {};
  std::filesystem::path out;
  TrainConfig config;
  double minutes = 0;      ///< Ends at the first step after this time; 0: never.
  int threads = 0;         ///< 0: all processors; the result does not depend on it.
  bool resume = false;     ///< Goes on from the state in `out`, if there is one.
  bool overwrite = false;  ///< Starts anew where `out` holds a training.
  bool nodes = false;      ///< One process of several, see ProcessGroupFromEnvironment().
  /// Called with a warning for people.
  std::function<void(const std::string&)> warn = [](const std::string&) {};
};

struct TrainingOutcome {
  bool writes = true;  ///< This process is the one of the group that writes.
  std::uint64_t steps_done = 0;
  std::uint64_t steps_total = 0;
  std::size_t train_samples = 0;
  std::size_t validation_samples = 0;
  std::optional<TurnedAccuracy> turned = {};  ///< At "handle": on the validation set.
  std::optional<EpochLosses> last_epoch = {};
};

/// Name of the page with the curves, in the folder of the policy.
inline constexpr const char* kCurvesPage = "training.html";

/// Trains a stage's policy and shows progress. Writes policy.safetensors and policy.json, best/ (as
/// each network was when it erred least), kCurvesPage, the losses and config.yaml; at the end of
/// each epoch the state that `resume` reads. Stopped by a signal, it leaves state and curves, and
/// no policy of the steps since.
///
/// @throws Error(kInvalidArgument) if `out` holds a training and neither `resume` nor `overwrite`
///     says what to do, or `from` has other branches; Error(kIncomplete) if a loss stops being
///     finite, with what is left; else as ReadStageDataset() and TrainStage().
TrainingOutcome TrainIntoFolder(const TrainingRequest& request);

/// What came of a training, for people: where the policy is, from how many samples, and what it
/// lost in the last epoch.
std::string OutcomeText(const TrainingOutcome& outcome, const TrainingRequest& request);

/// The losses in units that people think in, such as "position 1.20 mm, rotation 0.80 deg"; what is
/// not known yet is left out.
std::string LossText(const StageLosses& losses, NetworkFamily family);

}  // namespace doorforge
