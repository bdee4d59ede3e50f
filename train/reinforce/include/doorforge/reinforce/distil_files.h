// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/reinforce/ppo_files.h"
#include "doorforge/training/dagger.h"

namespace doorforge {

/// A training's state beside its samples, as it lies in a folder.
struct DistilProgress {
  DaggerState state;
  std::vector<std::string> samples_sha256;  ///< Of the file of each round.
};

/// Writes `samples/round_<round>.safetensors` and returns its SHA-256; rounds count from 0.
std::string WriteDistilSamples(const std::filesystem::path& folder, std::uint64_t round,
                               const DaggerSamples& samples);

/// The samples of the rounds that are done, the newest `buffer` of them.
///
/// @throws Error(kMissing) without a file; Error(kFormat) if one is damaged.
DaggerSamples ReadDistilSamples(const std::filesystem::path& folder, const DistilProgress& progress,
                                const DaggerTask& task, std::size_t buffer);

/// Writes `training.safetensors`, so that a crash leaves either the old state or the new one.
void WriteDistilState(const std::filesystem::path& folder, const DistilProgress& progress,
                      const PpoOrigin& origin);

/// Reads it back, exactly. Throws as ReadPpoState().
///
/// @param initial InitialDaggerState() of the config: says the sizes.
DistilProgress ReadDistilState(const std::filesystem::path& folder, const PpoOrigin& expected,
                               DaggerState initial);

/// Writes curves and page, as WritePpoCurves() and PpoPage() do.
void WriteDistilCurves(const std::filesystem::path& folder, const DaggerState& state,
                       const DaggerConfig& config, const PpoOrigin& origin);

}  // namespace doorforge
