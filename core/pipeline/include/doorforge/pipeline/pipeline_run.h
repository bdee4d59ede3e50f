// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "doorforge/pipeline/pipeline_graph.h"

namespace doorforge {

/// Is given text for people, line ends included.
using PipelineTextSink = std::function<void(const std::string& text)>;

/// How a pipeline is carried out; none of it changes what is made.
struct PipelineRun {
  std::filesystem::path out;  ///< Everything is made below it.
  int threads = 0;            ///< 0: all processors.
  bool overwrite = false;     ///< Outputs of steps whose inputs changed may be replaced.
  /// What other builds finished counts as done where nothing else has changed.
  bool any_build = false;
  /// Standard output is for one JSON document: what steps print goes among the messages.
  bool json = false;
  /// For messages: how the user goes on after an interruption.
  std::string again = "give the same command again";
  PipelineTextSink progress = {};  ///< It hears of each step as it begins; may be empty.
  PipelineTextSink result = {};    ///< It gets the table of success of each report; may be empty.
};

/// Runs the steps that are not done, each as its own program. Prints nothing itself. Returns the
/// exit code: 0, or 128 + the signal that stopped it; the same call goes on then.
///
/// @throws Error(kInvalidArgument) if the folder holds something else, another process works in it,
///     or a step would replace what is there without `overwrite`; Error(kIncomplete) if a step
///     failed.
int RunPipeline(const Pipeline& pipeline, const PipelineRun& run);

/// Returns the steps, what would be done about each and why, and the time and space that the preset
/// expects, as a table or, with PipelineRun::json, as a document. Changes nothing.
std::string PlanPipeline(const Pipeline& pipeline, const PipelineRun& run);

/// Takes a "plan" from before the one name that a user gives, and returns whether it was there.
///
/// @param words One or two. Throws Error(kInvalidArgument) if the first of two is another word.
bool TakePlan(std::vector<std::string>& words);

}  // namespace doorforge
