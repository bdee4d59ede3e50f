// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/report/over_trainings.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

OverTrainings Over(std::vector<double> rates) {
  OverTrainings over{std::move(rates), 0, 0};
  const auto n = static_cast<double>(over.rates.size());
  for (const double rate : over.rates) over.mean += rate / n;
  double squares = 0;
  for (const double rate : over.rates) squares += (rate - over.mean) * (rate - over.mean);
  if (n > 1) over.deviation = std::sqrt(squares / (n - 1));
  return over;
}

// What an episode is, whoever plays it.
std::string NameOf(const EvaluatedEpisode& episode) {
  return "door " + episode.door_id + ", seed " + std::to_string(episode.seed) + ", episode " +
         std::to_string(episode.episode);
}

void RequireSameEpisodes(std::span<const EvaluationReport> reports) {
  const EvaluationReport& first = reports[0];
  for (std::size_t r = 1; r < reports.size(); ++r) {
    const std::string which = "report " + std::to_string(r + 1);
    Require(reports[r].doors == first.doors && reports[r].episodes.size() == first.episodes.size(),
            ErrorCode::kInvalidArgument,
            which +
                ": is not of the same doors and seeds as the first; give reports of one "
                "command that differ in the policies alone");
    for (std::size_t i = 0; i < first.episodes.size(); ++i)
      Require(NameOf(reports[r].episodes[i]) == NameOf(first.episodes[i]),
              ErrorCode::kInvalidArgument,
              which + ": has " + NameOf(reports[r].episodes[i]) + " where the first has " +
                  NameOf(first.episodes[i]));
  }
}

double SuccessOf(const EvaluatedEpisode& episode) {
  return episode.outcome == EpisodeOutcome::kOpened ? 1 : 0;
}

GroupOverTrainings Summarise(std::span<const EvaluationReport> reports, const EpisodeGroup& group) {
  std::vector<double> rates;
  std::vector<ClusteredTrial> trials;
  for (const EvaluationReport& report : reports) {
    const std::vector<EvaluatedEpisode> episodes = OfGroup(report.episodes, group);
    trials.resize(episodes.size());
    double opened = 0;
    for (std::size_t i = 0; i < episodes.size(); ++i) {
      trials[i].body = episodes[i].body;
      trials[i].handle = episodes[i].handle;
      trials[i].success += SuccessOf(episodes[i]) / static_cast<double>(reports.size());
      opened += SuccessOf(episodes[i]);
    }
    rates.push_back(opened / static_cast<double>(episodes.size()));
  }
  return {group, Over(std::move(rates)), ClusteredRate(trials)};
}

OverTrainings MeanOfCategories(const TrainingsSummary& summary) {
  std::vector<double> sums(summary.trainings);
  double categories = 0;
  for (const GroupOverTrainings& row : summary.groups) {
    if (!row.group.category || row.group.latched) continue;
    ++categories;
    for (std::size_t t = 0; t < sums.size(); ++t) sums[t] += row.opened.rates[t];
  }
  for (double& sum : sums) sum /= categories;
  return Over(std::move(sums));
}

std::string Percents(const std::vector<double>& rates) {
  std::string text;
  for (const double rate : rates) {
    char number[16];
    std::snprintf(number, sizeof number, "%s%.1f", text.empty() ? "" : ", ", 100 * rate);
    text += number;
  }
  return text;
}

nlohmann::ordered_json ToJson(const OverTrainings& over) {
  return {{"mean", over.mean}, {"deviation", over.deviation}, {"rates", over.rates}};
}

}  // namespace

TrainingsSummary SummariseTrainings(std::span<const EvaluationReport> reports) {
  Require(!reports.empty() && !reports[0].episodes.empty(), ErrorCode::kInvalidArgument,
          "no report with episodes was given");
  RequireSameEpisodes(reports);
  TrainingsSummary summary{reports.size(), reports[0].doors.size(), {}, {}};
  for (const EpisodeGroup& group : GroupsOf(reports[0].episodes))
    summary.groups.push_back(Summarise(reports, group));
  summary.mean_of_categories = MeanOfCategories(summary);
  return summary;
}

std::string TrainingsTable(const TrainingsSummary& summary) {
  char line[200];
  std::snprintf(line, sizeof line, "%zu doors; mean over %zu training%s\n", summary.doors,
                summary.trainings, summary.trainings == 1 ? "" : "s");
  std::string text = line;
  std::snprintf(line, sizeof line, "%-28s %8s   %15s   %10s   %s\n", "success > 45 deg", "mean",
                "95 % interval", "deviation", "of each training");
  text += line;
  for (const GroupOverTrainings& row : summary.groups) {
    std::snprintf(line, sizeof line, "%-28s %6.1f %%   %5.1f - %5.1f %%   %8.1f %%   ",
                  NameOf(row.group).c_str(), 100 * row.opened.mean, 100 * row.rate.low,
                  100 * row.rate.high, 100 * row.opened.deviation);
    text += line + Percents(row.opened.rates) + "\n";
  }
  const OverTrainings& mean = summary.mean_of_categories;
  std::snprintf(line, sizeof line, "%-28s %6.1f %%   %15s   %8.1f %%   ", "mean of the categories",
                100 * mean.mean, "", 100 * mean.deviation);
  return text + line + Percents(mean.rates) + "\n";
}

nlohmann::ordered_json TrainingsToJson(const TrainingsSummary& summary) {
  nlohmann::ordered_json success = nlohmann::ordered_json::object();
  for (const GroupOverTrainings& row : summary.groups) {
    nlohmann::ordered_json json = ToJson(row.opened);
    json["low"] = row.rate.low;
    json["high"] = row.rate.high;
    json["episodes"] = row.rate.episodes;
    json["trials"] = row.rate.trials;
    success[NameOf(row.group)] = std::move(json);
  }
  return {{"schema", "doorforge.trainings"},
          {"schema_version", 1},
          {"trainings", summary.trainings},
          {"doors", summary.doors},
          {"success", std::move(success)},
          {"mean_of_categories", ToJson(summary.mean_of_categories)}};
}

}  // namespace doorforge
