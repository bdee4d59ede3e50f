// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/report/report.h"
#include "doorforge/report/success_statistics.h"

namespace doorforge {

/// A share over several trainings.
struct OverTrainings {
  std::vector<double> rates;  ///< There is one a training, in the order of the reports.
  double mean = 0;
  double deviation = 0;  ///< Between trainings, unbiased (n - 1); 0 for one.
};

/// What the trainings of one recipe come to on the episodes of a group.
struct GroupOverTrainings {
  EpisodeGroup group;
  OverTrainings opened;
  /// The interval of the mean for other bodies and handles, as ClusteredRate() of the mean over the
  /// trainings on each door; how trainings differ is not in it.
  SuccessRate rate;
};

/// Several trainings of one recipe, judged on the same episodes.
struct TrainingsSummary {
  std::size_t trainings = 0;
  std::size_t doors = 0;
  std::vector<GroupOverTrainings> groups;  ///< GroupsOf() gives them.
  /// It is the mean of the categories that occur, each counted alike, whatever the number of its
  /// doors.
  OverTrainings mean_of_categories;
};

/// @throws Error(kInvalidArgument) without reports, or if they are not of the same doors and
///     episodes, which it names; success on others would be compared with it.
TrainingsSummary SummariseTrainings(std::span<const EvaluationReport> reports);

/// A table for people, a line a group.
std::string TrainingsTable(const TrainingsSummary& summary);

/// {"schema": "doorforge.trainings", "schema_version": 1, "trainings", "doors", "success":
/// {"<group>": {"mean", "deviation", "rates", "low", "high", "episodes", "trials"}},
/// "mean_of_categories": {"mean", "deviation", "rates"}}.
nlohmann::ordered_json TrainingsToJson(const TrainingsSummary& summary);

}  // namespace doorforge
