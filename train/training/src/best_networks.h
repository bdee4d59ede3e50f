// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doorforge/training/train_stage.h"

namespace doorforge::internal {

/// Called when an epoch has ended: takes the networks that are now better than after all epochs
/// before.
void UpdateBest(const TrainConfig& config, TrainerState& state);

}  // namespace doorforge::internal
