// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/reinforce/ppo_files.h"
#include "doorforge/training/trajectories.h"

namespace doorforge {

/// A training's state beside its samples, as it lies in a folder.
struct TrajectoryProgress {
  TrajectoryState state;
  std::vector<std::string> samples_sha256;  ///< Of the file of each round.
};

/// Writes `samples/round_<round>.safetensors` and returns its SHA-256; rounds count from 0.
std::string WriteTrajectorySamples(const std::filesystem::path& folder, std::uint64_t round,
                                   const TrajectorySamples& samples);

/// The samples of the rounds that are done.
///
/// @param empty Says the sizes.
/// @throws Error(kMissing) without a file; Error(kFormat) if one is damaged.
TrajectorySamples ReadTrajectorySamples(const std::filesystem::path& folder,
                                        const TrajectoryProgress& progress,
                                        TrajectorySamples empty);

/// Writes `training.safetensors`, so that a crash leaves either the old state or the new one.
void WriteTrajectoryState(const std::filesystem::path& folder, const TrajectoryProgress& progress,
                          const PpoOrigin& origin);

/// Reads it back, exactly. Throws as ReadPpoState().
///
/// @param initial InitialTrajectoryState() of the config: says the sizes.
TrajectoryProgress ReadTrajectoryState(const std::filesystem::path& folder,
                                       const PpoOrigin& expected, TrajectoryState initial);

/// Writes curves and page, as WritePpoCurves() and PpoPage() do.
void WriteTrajectoryCurves(const std::filesystem::path& folder, const TrajectoryState& state,
                           const TrajectoryLearning& config, const PpoOrigin& origin);

}  // namespace doorforge
