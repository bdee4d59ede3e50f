// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace doorforge {

/// Sums of products of settings: {"fixed": 30, "episodes": 0.2, "episodes*epochs": 0.4}.
using CostTerms = std::map<std::string, double>;

/// One step: a command of `doorforge`, what it needs and what it makes.
struct PipelineStep {
  std::string name;
  std::string does;                  ///< For people.
  std::vector<std::string> command;  ///< Verb and arguments, with {placeholders}.
  /// Folder that the command makes, below the pipeline's; empty for a check, which makes nothing.
  std::string output;
  std::vector<std::string> records;  ///< Endings of the files below `output` that describe it.
  std::vector<std::string> needs;    ///< Steps whose outputs the command reads.
  /// What is added to the command to go on after an interruption, maybe nothing; without it a
  /// step that was interrupted starts again.
  std::optional<std::string> resume;
  std::vector<int> ok_exit_codes = {0};  ///< Exit codes after which the step is done.
  CostTerms core_seconds;
  CostTerms mebibytes;
  /// A step whose output stands for this one's as well where it is given: doors of another size are
  /// not made of doors that are the user's own.
  std::string given_with;
  /// Folders of the user's that stand for the output; the step itself has nothing to do then.
  std::vector<std::string> given;
};

/// A declared graph of steps, each after those that it needs.
struct Pipeline {
  std::string name;
  std::string about;
  nlohmann::ordered_json settings;  ///< Numbers and texts that placeholders stand for.
  std::vector<PipelineStep> steps;
};

/// Reads a preset of data/pipelines, or a file of the user's (docs/pipeline.md).
///
/// @param name "quick", or a path that ends with ".yaml".
/// @param changes "key=value" for keys of its settings.
/// @throws Error(kMissing); Error(kInvalidConfig) on unknown keys and settings, a step that needs
///     one that does not come before it, or a placeholder that nothing stands for.
Pipeline ReadPipeline(const std::string& name, const std::vector<std::string>& changes);

/// Names of the presets.
std::vector<std::string> PipelinePresets();

/// What each preset is about, a line each, for the help.
std::string PresetsText();

/// Lets folders stand for the output of a step and of those that are given with it, and leaves out
/// the steps that only they needed.
/// Throws Error(kInvalidArgument) if there is no such step.
void GiveOutput(Pipeline& pipeline, const std::string& step,
                const std::vector<std::string>& folders);

/// The command with values in place of {placeholders}: settings, and those in `more`, which may
/// stand for several arguments. An argument with a placeholder for an empty text is left out.
/// Placeholders that `more` does not know either stay as they are.
std::vector<std::string> ExpandCommand(const PipelineStep& step,
                                       const nlohmann::ordered_json& settings,
                                       const std::map<std::string, std::vector<std::string>>& more);

/// The sum of the terms.
double CostOf(const CostTerms& terms, const nlohmann::ordered_json& settings);

}  // namespace doorforge
