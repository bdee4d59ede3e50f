// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace doorforge {

/// What decides a step's output, by name: the build, the command, and a hash for each step that it
/// needs. Equal inputs, equal output.
using StepInputs = std::vector<std::pair<std::string, std::string>>;

/// What is known of a step from earlier runs.
struct StepRecord {
  StepInputs inputs;
  std::string output_sha256;  ///< Empty until the step is done.
};

/// What is to be done about a step, and why.
enum class StepAction {
  kSkip,     ///< Done, nothing has changed.
  kStart,    ///< Never begun.
  kResume,   ///< Begun with these very inputs.
  kRestart,  ///< Begun or done, but not with these inputs, or the output is no longer what it was.
};
struct StepDecision {
  StepAction action = StepAction::kStart;
  std::string why;
};

/// The build that made a step's output; empty unless it is done.
std::string BuildThatFinished(const StepRecord& record);

/// @param output_sha256 Of what is there now; empty if there is nothing.
StepDecision Decide(const std::optional<StepRecord>& record, const StepInputs& inputs,
                    const std::string& output_sha256);

/// Hash over the names and bytes of the files below the folders whose names end with one of
/// `endings`; empty if there is none. Data sets, doors and policies have records that hold the
/// hashes of everything else. Throws Error(kIo).
std::string HashOfRecords(const std::vector<std::string>& folders,
                          const std::vector<std::string>& endings);

/// A step's record in the folder of a pipeline, pipeline/<step>.json; written as committed files
/// are. Reading throws Error(kFormat) if it is damaged.
void WriteStepRecord(const std::filesystem::path& out, const std::string& step,
                     const StepRecord& record);
std::optional<StepRecord> ReadStepRecord(const std::filesystem::path& out, const std::string& step);
void RemoveStepRecord(const std::filesystem::path& out, const std::string& step);

}  // namespace doorforge
