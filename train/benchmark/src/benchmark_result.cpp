// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/benchmark/benchmark_result.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <numbers>
#include <utility>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/report/report_folder.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

template <class T>
void Append(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

// The reports of a row, one a training: both sides of the doors in one.
std::vector<EvaluationReport> ReportsOf(const std::vector<const BenchmarkPart*>& parts,
                                        const fs::path& out) {
  std::vector<EvaluationReport> reports;
  for (const BenchmarkPart* part : parts) {
    EvaluationReport report = ReadReport(out / part->report);
    if (static_cast<std::size_t>(part->training) == reports.size()) {
      reports.push_back(std::move(report));
      continue;
    }
    Append(report.doors, reports.back().doors);
    Append(report.episodes, reports.back().episodes);
  }
  return reports;
}

double ShareOpened(const std::vector<EvaluationReport>& reports, std::size_t episode) {
  double opened = 0;
  for (const EvaluationReport& report : reports)
    opened += report.episodes[episode].outcome == EpisodeOutcome::kOpened ? 1 : 0;
  return opened / static_cast<double>(reports.size());
}

std::vector<double> PastDegrees(const std::vector<EvaluationReport>& reports) {
  constexpr int kLastDegree = 90;
  std::map<Category, std::vector<double>> peaks_deg;
  for (const EvaluationReport& report : reports) {
    for (const EvaluatedEpisode& episode : report.episodes)
      peaks_deg[episode.category].push_back(episode.peak_hinge_rad * 180 / std::numbers::pi);
  }
  std::vector<double> shares(kLastDegree + 1, 0.0);
  for (int degree = 0; degree <= kLastDegree; ++degree) {
    for (const auto& [category, peaks] : peaks_deg) {
      const auto past = std::ranges::count_if(peaks, [&](double peak) { return peak > degree; });
      shares[static_cast<std::size_t>(degree)] +=
          static_cast<double>(past) / static_cast<double>(peaks.size() * peaks_deg.size());
    }
  }
  return shares;
}

// Doors that a row composed itself have other names, and the same bodies and handles.
std::string PairOf(const EvaluatedEpisode& episode) {
  return "body " + episode.body + ", handle " + episode.handle + ", seed " +
         std::to_string(episode.seed) + ", episode " + std::to_string(episode.episode);
}

ClusteredDifference Compare(const std::vector<EvaluationReport>& first,
                            const std::vector<EvaluationReport>& second,
                            const std::array<std::string, 2>& names) {
  std::map<std::string, double> before;
  for (std::size_t i = 0; i < first[0].episodes.size(); ++i)
    before.emplace(PairOf(first[0].episodes[i]), ShareOpened(first, i));
  std::vector<ClusteredTrial> trials;
  for (std::size_t i = 0; i < second[0].episodes.size(); ++i) {
    const EvaluatedEpisode& episode = second[0].episodes[i];
    const auto pair = before.find(PairOf(episode));
    Require(pair != before.end() && before.size() == second[0].episodes.size(),
            ErrorCode::kInvalidArgument,
            "row " + names[0] + ": is not of the same doors and seeds as row " + names[1] +
                ", which has " + PairOf(episode));
    trials.push_back({episode.body, episode.handle, ShareOpened(second, i) - pair->second});
  }
  return MeanDifference(trials);
}

template <class... Values>
std::string Format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

// The category's group over the trainings; nothing where no door of it was evaluated.
const GroupOverTrainings* GroupOf(const TrainingsSummary& summary, Category category) {
  const auto found =
      std::ranges::find(summary.groups, EpisodeGroup{category, {}}, &GroupOverTrainings::group);
  return found == summary.groups.end() ? nullptr : &*found;
}

std::string HeadLine() {
  std::string line = Format("%-22s %5s", "opened beyond 45 deg", "");
  for (const auto& category : kCategories)
    line += Format(" %12.12s", std::string(category.name).c_str());
  return line + Format(" %18s\n", "mean of categories");
}

std::string LinesOf(const BenchmarkRowResult& row) {
  std::string ours = Format("%-22s %5s", row.row.name.c_str(), "");
  std::string paper = Format("%-22s %5s", "", "paper");
  for (std::size_t i = 0; i < std::size(kCategories); ++i) {
    const GroupOverTrainings* group = GroupOf(row.summary, kCategories[i].value);
    ours += group == nullptr ? Format(" %12s", "-")
                             : Format(" %4.0f %3.0f-%3.0f", 100 * group->opened.mean,
                                      100 * group->rate.low, 100 * group->rate.high);
    if (i < row.row.paper.size()) paper += Format(" %4.0f %7s", 100 * row.row.paper[i], "");
  }
  const OverTrainings& mean = row.summary.mean_of_categories;
  ours += Format(" %6.1f", 100 * mean.mean);
  if (mean.rates.size() > 1) ours += Format(" +- %4.1f", 100 * mean.deviation);
  return ours + "\n" + (row.row.paper.empty() ? "" : paper + "\n");
}

}  // namespace

BenchmarkResult ReadBenchmarkResult(const Benchmark& benchmark, const BenchmarkPlan& plan,
                                    const fs::path& out) {
  BenchmarkResult result{benchmark, {}, {}};
  std::vector<std::vector<EvaluationReport>> reports;
  for (std::size_t i = 0; i < benchmark.rows.size(); ++i) {
    std::vector<const BenchmarkPart*> parts;
    BenchmarkRowResult row{benchmark.rows[i], {}, 0, {}, {}};
    for (const BenchmarkPart& part : plan.parts) {
      if (part.row != i) continue;
      parts.push_back(&part);
      row.reports.push_back(part.report);
      row.train_minutes = row.row.pipeline.empty() ? 0 : part.train_seconds / 60;
    }
    reports.push_back(ReportsOf(parts, out));
    row.summary = SummariseTrainings(reports.back());
    row.past_degree = PastDegrees(reports.back());
    result.rows.push_back(std::move(row));
  }
  for (std::size_t i = 0; i + 1 < reports.size(); ++i)
    result.comparisons.push_back({i, reports.size() - 1,
                                  Compare(reports[i], reports.back(),
                                          {benchmark.rows[i].name, benchmark.rows.back().name})});
  return result;
}

std::string BenchmarkText(const BenchmarkResult& result) {
  std::string text = HeadLine();
  for (const BenchmarkRowResult& row : result.rows) text += LinesOf(row);
  if (result.comparisons.empty()) return text;
  text += "\n" + result.rows.back().row.name + " opens more often than\n";
  for (const BenchmarkComparison& row : result.comparisons)
    text += Format("  %-22s by %6.1f points (95 %%: %6.1f to %6.1f)%s\n",
                   result.rows[row.first].row.name.c_str(), 100 * row.difference.mean,
                   100 * row.difference.low, 100 * row.difference.high,
                   row.difference.IsSignificant() ? "" : ", which may be chance");
  return text;
}

nlohmann::ordered_json BenchmarkToJson(const BenchmarkResult& result) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const BenchmarkRowResult& row : result.rows)
    rows.push_back({{"name", row.row.name},
                    {"title", row.row.title},
                    {"paper", row.row.paper},
                    {"success", TrainingsToJson(row.summary)},
                    {"train_core_minutes", row.train_minutes},
                    {"reports", row.reports},
                    {"past_degree", row.past_degree}});
  nlohmann::ordered_json comparisons = nlohmann::ordered_json::array();
  for (const BenchmarkComparison& row : result.comparisons)
    comparisons.push_back({{"row", result.rows[row.second].row.name},
                           {"with", result.rows[row.first].row.name},
                           {"mean", row.difference.mean},
                           {"low", row.difference.low},
                           {"high", row.difference.high},
                           {"significant", row.difference.IsSignificant()}});
  return {{"schema", "doorforge.benchmark"},      {"schema_version", 1},
          {"benchmark", result.benchmark.name},   {"doors", result.benchmark.size.doors},
          {"seeds", result.benchmark.size.seeds}, {"rows", std::move(rows)},
          {"comparisons", std::move(comparisons)}};
}

}  // namespace doorforge
