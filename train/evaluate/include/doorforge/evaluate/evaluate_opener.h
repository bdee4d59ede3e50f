// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/evaluate/evaluation_config.h"
#include "doorforge/registry/policy_registry.h"
#include "doorforge/registry/policy_set_factory.h"
#include "doorforge/report/report.h"
#include "doorforge/report/report_page.h"
#include "doorforge/schemas/door_set.h"
#include "doorforge/schemas/episode_film.h"

namespace doorforge {

/// What is to be evaluated.
struct EvaluationRequest {
  PolicyRegistry registry = BuiltInPolicies();
  PolicyWords policies;  ///< Who acts at each stage; policies of one's own are in the registry.
  DoorSelection doors = {.folders = {}, .default_side = "test"};
  /// Data sets that the policy was trained from, in their order: the report then lists and shows
  /// the doors. May be empty. Of an opener of one's own, nothing else says which doors it has seen.
  std::vector<std::filesystem::path> data;
  bool allow_seen = false;  ///< Doors with trained-on parts are evaluated, and marked as such.
  /// Doors and episodes are drawn, for a page. What is counted does not depend on it.
  bool pictures = true;
  bool films = false;  ///< Every failure is filmed, for which it is run once more.
  EvaluationConfig config;
  int threads = 0;      ///< 0: all processors. Does not change the result.
  std::string command;  ///< Goes into the report.
};

struct Evaluation {
  std::vector<std::string> notes;  ///< On the doors, see DoorSet.
  EvaluationReport report;
  ReportPictures pictures;
  std::vector<EpisodeFilm> films;  ///< These show the failures, where they were asked for.
};

/// Closed-loop evaluation of the opening stage (UniDoorManip, Section 5): in every scene somebody
/// takes hold, somebody turns the handle, then the opener opens; the expert stands in wherever
/// nobody else is named. Progress is shown on standard error.
///
/// Same request, same report and pictures, for any number of threads.
///
/// @throws Error as PolicySetFactory; Error(kInvalidArgument) if a policy was trained on a door's
/// body or handle, naming these
///     doors, or if `data` is not what the policy was trained from;
///     Error(kInvalidConfig); Error(kMissing or kFormat) as the readers of policy, doors and data;
///     Error(kIncomplete) if the program was asked to stop.
Evaluation EvaluateOpener(const EvaluationRequest& request);

}  // namespace doorforge
