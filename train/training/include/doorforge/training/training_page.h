// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "doorforge/policy/policy_file.h"
#include "doorforge/training/loss_files.h"

namespace doorforge {

/// What a training is, beside how far it has come.
struct TrainingRun {
  PolicyProvenance provenance;
  TrainingPace pace;
  std::size_t train_samples = 0;
  std::size_t validation_samples = 0;
};

/// One HTML page without any reference to other files or hosts: the losses over the epochs on
/// training and validation set with the best epoch marked, the learning rate, a table of the same
/// numbers, and all settings. As long as epochs are missing it asks browsers to load it again every
/// half minute. Well-formed XML; equal arguments give equal bytes.
std::string TrainingPage(const TrainerState& state, const TrainingRun& run);

}  // namespace doorforge
