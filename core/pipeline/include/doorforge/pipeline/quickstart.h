// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "doorforge/pipeline/pipeline_run.h"

namespace doorforge {

/// The whole chain at small size: parts, doors, validation, shards, policy, report.
struct QuickstartRequest {
  std::filesystem::path out = "run/quickstart";  ///< Everything is made below it.
  /// Folder of objects of UniDoorManip to import; empty: the embedded catalogue.
  std::filesystem::path assets = {};
  int episodes = 220;              ///< So many of the expert are collected.
  int epochs = 4;                  ///< Passes over the collected samples.
  int threads = 0;                 ///< 0: all processors.
  std::uint64_t seed = 7;          ///< Decides every random choice.
  bool overwrite = false;          ///< The folder `out` of an earlier quickstart is replaced.
  bool resume = false;             ///< The steps that are done in `out` are kept.
  PipelineTextSink progress = {};  ///< It means what PipelineRun::progress does.
  PipelineTextSink result = {};    ///< It means what PipelineRun::result does.
};

/// Runs the preset "quickstart" as RunPipeline() does, and returns its exit code.
///
/// @throws Error(kInvalidArgument) if `out` holds something and neither `resume` nor `overwrite`
///     says what to do, is no quickstart's, or another process works there; else as RunPipeline().
int RunQuickstart(const QuickstartRequest& request);

/// The step that draws training and held-out pairs of parts, see SplitIntoDoors(), and composes
/// them into OUT/train and OUT/test by `doorforge compose`. Doors that are there already are kept.
///
/// @throws Error(kIncomplete) if a door cannot be composed; else as SplitIntoDoors().
void ComposeQuickstartDoors(const std::filesystem::path& parts, const std::filesystem::path& out,
                            std::uint64_t seed, int threads);

}  // namespace doorforge
