// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/evaluate/door_folders.h"
#include "doorforge/evaluate/evaluation_config.h"
#include "doorforge/evaluate/report.h"
#include "doorforge/evaluate/report_page.h"

namespace doorforge {

/// What is to be evaluated.
struct EvaluationRequest {
  std::filesystem::path policy;  ///< Folder that `doorforge train open` wrote, or "expert".
  /// Folder that `doorforge train handle` wrote; empty: the rule turns the handle.
  std::filesystem::path handler;
  /// Folder that `doorforge train grasp` wrote, or "random": sampled grasps as in `datagen grasp`.
  /// Empty: the expert's grasp.
  std::filesystem::path grasper;
  std::vector<std::string> doors;  ///< Folders of composed doors, see ReadDoors().
  DoorSelection selection;         ///< Which of them.
  /// Data sets that the policy was trained from, in their order: the report then lists and shows
  /// the doors. May be empty.
  std::vector<std::filesystem::path> data;
  bool allow_seen = false;  ///< Doors with trained-on parts are evaluated, and marked as such.
  EvaluationConfig config;
  int threads = 0;      ///< 0: all processors. Does not change the result.
  std::string command;  ///< Goes into the report.
};

struct Evaluation {
  EvaluationReport report;
  ReportPictures pictures;
};

/// Closed-loop evaluation of the opening stage (UniDoorManip, Section 6): in every scene the expert
/// or a trained grasper takes hold, the rule or a trained policy turns the handle, then the policy
/// opens. The rule-based expert by itself with policy "expert". Progress is shown on standard
/// error.
///
/// Same request, same report and pictures, for any number of threads.
///
/// @throws Error(kInvalidArgument) if a policy was trained on a door's body or handle, naming these
///     doors, or if `data` is not what the policy was trained from;
///     Error(kInvalidConfig); Error(kMissing or kFormat) as the readers of policy, doors and data;
///     Error(kIncomplete) if the program was asked to stop.
Evaluation EvaluateOpener(const EvaluationRequest& request);

}  // namespace doorforge
