// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "doorforge/policy/training_curves.h"
#include "doorforge/training/train_stage.h"

namespace doorforge {

/// When a training's steps come.
struct TrainingPace {
  TrainConfig config;
  std::uint64_t steps_per_epoch = 1;
};

/// Writes `losses.jsonl` (a line a step: step, epoch and learning rate, then the losses),
/// `losses.json` (the curves) and `events.out.tfevents.doorforge` (both, for TensorBoard).
void WriteLosses(const std::filesystem::path& folder, const TrainerState& state,
                 const TrainingPace& pace);

/// The losses over the epochs done, one curve a loss.
std::vector<TrainingCurve> CurvesOf(const TrainerState& state);

}  // namespace doorforge
