// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/datagen/verify_dataset.h"

#include "trained_policy.h"

namespace doorforge {

/// Of `dataset verify --regenerate`.
struct RegenerateOptions {
  std::string share;  ///< "1%"; empty: nothing is made again.
  std::vector<std::string> doors;
  std::string robot;  ///< See RecordedRobot().
  PolicyFolders policies;
};

void AddRegenerateOptions(CLI::App& app, RegenerateOptions& options);

/// Throws Error(kInvalidArgument) on options that do not go together.
void CheckRegenerateOptions(const RegenerateOptions& options);

/// Makes a share of the dataset's episodes again. Throws Error(kInvalidArgument) if build, doors or
/// policies are not those that it was made with.
std::vector<DatasetFinding> Regenerate(const std::filesystem::path& folder, int threads,
                                       const RegenerateOptions& options);

}  // namespace doorforge
