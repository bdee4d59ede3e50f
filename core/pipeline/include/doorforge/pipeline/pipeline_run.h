// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "doorforge/pipeline/pipeline_graph.h"

namespace doorforge {

/// How a pipeline is carried out; none of it changes what is made.
struct PipelineRun {
  std::filesystem::path out;  ///< Everything is made below it.
  int threads = 0;            ///< 0: all processors.
  bool overwrite = false;     ///< Outputs of steps whose inputs changed may be replaced.
  /// What other builds finished counts as done where nothing else has changed.
  bool any_build = false;
  bool json = false;  ///< The plan as one JSON document.
  /// For messages: how the user goes on after an interruption.
  std::string again = "give the same command again";
};

/// Runs the steps that are not done, each as its own program, and prints the success table. Returns
/// the exit code: 0, or 128 + the signal that stopped it; the same call goes on then.
///
/// @throws Error(kInvalidArgument) if the folder holds something else, another process works in it,
///     or a step would replace what is there without `overwrite`; Error(kIncomplete) if a step
///     failed.
int RunPipeline(const Pipeline& pipeline, const PipelineRun& run);

/// Prints the steps, what would be done about each and why, and the time and space that the preset
/// expects. Changes nothing.
int PlanPipeline(const Pipeline& pipeline, const PipelineRun& run);

}  // namespace doorforge
