// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "doorforge/training/ppo.h"

namespace doorforge {

/// What a state belongs to: who goes on must have been given the same.
struct PpoOrigin {
  std::string config;        ///< The effective settings as one JSON text.
  std::string doors_sha256;  ///< It hashes the ids and contents of the doors.
};

/// Writes `training.safetensors`, one file with all that PpoState holds, so that a crash leaves
/// either the old state or the new one.
void WritePpoState(const std::filesystem::path& folder, const PpoState& state,
                   const PpoOrigin& origin);

bool HasPpoState(const std::filesystem::path& folder);

/// Reads it back, exactly.
///
/// @param initial InitialPpoState() of the task and config: says the sizes.
/// @throws Error(kInvalidArgument) if it was written for other settings or doors, naming what
///     differs; Error(kFormat) if it is damaged or of another kind of training.
PpoState ReadPpoState(const std::filesystem::path& folder, const PpoOrigin& expected,
                      PpoState initial);

/// Writes `losses.jsonl` (a line an update with all PpoColumns()) and
/// `events.out.tfevents.doorforge`, the same for TensorBoard.
void WritePpoCurves(const std::filesystem::path& folder, const PpoState& state);

/// One HTML page without any reference to other files or hosts: curves over the decisions, and all
/// settings. As long as updates are missing it asks browsers to load it again every half minute.
/// Well-formed XML; equal arguments give equal bytes.
std::string PpoPage(const PpoState& state, const PpoConfig& config, const PpoOrigin& origin);

}  // namespace doorforge
