// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "doorforge/policy/policy_file.h"
#include "doorforge/training/train_stage.h"

namespace doorforge {

/// Writes `training.safetensors`, one file with all that TrainerState holds, so that a crash leaves
/// either the old state or the new one.
void WriteTrainerState(const std::filesystem::path& folder, const TrainerState& state,
                       const PolicyProvenance& provenance);

/// Whether the folder holds a state to resume from.
bool HasTrainerState(const std::filesystem::path& folder);

/// Reads it back, exactly. Throws Error(kInvalidArgument) if it was written for another config or
/// data set, naming what differs; Error(kFormat) if it is damaged.
TrainerState ReadTrainerState(const std::filesystem::path& folder,
                              const PolicyProvenance& expected);

}  // namespace doorforge
