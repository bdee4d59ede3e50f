// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "doorforge/evaluate/evaluation_config.h"
#include "doorforge/report/report.h"
#include "doorforge/report/report_page.h"
#include "doorforge/schemas/door_set.h"
#include "doorforge/schemas/policy.h"

namespace doorforge {

/// Policies that are no folder, such as a class of one's own. A new one is made for every thread;
/// all must be equal and forget everything at Reset(). They are called from one thread at a time.
struct OwnPolicies {
  std::string name;                                              ///< In table and report.
  std::function<std::unique_ptr<Policy>()> make_open = nullptr;  ///< Opens; null: nobody.
  /// Turns the handle; null: `handler`, or the rule.
  std::function<std::unique_ptr<Policy>()> make_handle = nullptr;
};

/// What is to be evaluated.
struct EvaluationRequest {
  /// Folder that `doorforge train open` wrote, or "expert". Not read where `own` opens.
  std::filesystem::path policy;
  /// Folder that `doorforge train handle` wrote; empty: the rule turns the handle.
  std::filesystem::path handler;
  /// Folder that `doorforge train grasp` wrote, or "random": sampled grasps as in `datagen grasp`.
  /// Empty: the expert's grasp.
  std::filesystem::path grasper;
  OwnPolicies own;
  DoorSelection doors = {.folders = {}, .default_side = "test"};
  /// Data sets that the policy was trained from, in their order: the report then lists and shows
  /// the doors. May be empty. Of a policy of one's own, nothing else says which doors it has seen.
  std::vector<std::filesystem::path> data;
  bool allow_seen = false;  ///< Doors with trained-on parts are evaluated, and marked as such.
  EvaluationConfig config;
  int threads = 0;      ///< 0: all processors. Does not change the result.
  std::string command;  ///< Goes into the report.
};

struct Evaluation {
  std::vector<std::string> notes;  ///< On the doors, see DoorSet.
  EvaluationReport report;
  ReportPictures pictures;
};

/// Closed-loop evaluation of the opening stage (UniDoorManip, Section 5): in every scene the expert
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
