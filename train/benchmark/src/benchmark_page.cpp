// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/benchmark/benchmark_page.h"

#include <algorithm>
#include <array>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/html_text.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/page_style.h"
#include "doorforge/core/program.h"
#include "doorforge/core/svg_plot.h"
#include "doorforge/schemas/names.h"

namespace doorforge {
namespace {

using page::Escape;
using page::Fill;
using page::Fixed;

constexpr const char* kPaperNote =
    " Below ours the paper's figure: other doors, another simulator, and columns whose order the "
    "paper does not print.";

std::string Percent(double share) { return Fixed(100 * share, 0); }

std::string Cell(const std::string& text) { return "<td>" + text + "</td>"; }

std::string CategoryCell(const BenchmarkRowResult& row, std::size_t category) {
  const auto group =
      std::ranges::find(row.summary.groups, EpisodeGroup{kCategories[category].value, {}},
                        &GroupOverTrainings::group);
  std::string text = "&#8211;";
  if (group != row.summary.groups.end())
    text = "<b>" + Percent(group->opened.mean) + "</b><br/><small>" + Percent(group->rate.low) +
           "&#8211;" + Percent(group->rate.high) + "</small>";
  if (category < row.row.paper.size())
    text += "<br/><small>paper&#160;" + Percent(row.row.paper[category]) + "</small>";
  return Cell(text);
}

std::string MeanCell(const BenchmarkRowResult& row) {
  const OverTrainings& mean = row.summary.mean_of_categories;
  std::string text = "<b>" + Fixed(100 * mean.mean, 1) + "</b>";
  if (mean.rates.size() > 1)
    text += "<br/><small>&#177; " + Fixed(100 * mean.deviation, 1) + " over " +
            std::to_string(mean.rates.size()) + " trainings</small>";
  return Cell(text);
}

std::string SuccessTable(const BenchmarkResult& result) {
  std::string head = "<th>row</th>";
  for (const auto& category : kCategories)
    head += "<th>" + Escape(std::string(category.name)) + "</th>";
  std::string rows;
  for (const BenchmarkRowResult& row : result.rows) {
    rows += "<tr><td>" + Escape(row.row.title) + "<br/><small>" + Escape(row.row.name) +
            "</small></td>";
    for (std::size_t i = 0; i < std::size(kCategories); ++i) rows += CategoryCell(row, i);
    rows += MeanCell(row) + "</tr>\n";
  }
  return "<table><thead><tr>" + head + "<th>mean of categories</th></tr></thead><tbody>\n" + rows +
         "</tbody></table>";
}

// A dot at the difference to the last row, its interval as a whisker, from -100 to 100 points.
std::string DifferenceBar(const ClusteredDifference& difference) {
  const auto x = [](double share) { return Fixed(154 - 150 * share, 1); };
  return Fill(
      R"(<svg class="bar" viewBox="0 0 308 24" role="img" aria-label="{mean} points, interval {low} to {high}">)"
      R"(<title>{mean} points, 95 % interval {low} to {high}</title>)"
      R"(<path class="track" d="M154 2v20" stroke="currentColor"/>)"
      R"(<path class="whisker" stroke="currentColor" d="M{left} 12H{right}M{left} 8v8M{right} 8v8"/><circle class="mark" cx="{dot}" cy="12" r="4"/></svg>)",
      {{"mean", Fixed(-100 * difference.mean, 1)},
       {"low", Fixed(-100 * difference.high, 1)},
       {"high", Fixed(-100 * difference.low, 1)},
       {"left", x(difference.high)},
       {"right", x(difference.low)},
       {"dot", x(difference.mean)}});
}

std::string ComparisonTable(const BenchmarkResult& result) {
  if (result.comparisons.empty()) return "";
  std::string rows;
  for (const BenchmarkComparison& row : result.comparisons)
    rows +=
        "<tr>" + Cell(Escape(result.rows[row.first].row.title)) +
        Cell(Fixed(100 * row.difference.mean, 1)) +
        Cell(Fixed(100 * row.difference.low, 1) + " to " + Fixed(100 * row.difference.high, 1)) +
        Cell(row.difference.IsSignificant() ? "yes" : "may be chance") +
        Cell(DifferenceBar(row.difference)) + "</tr>\n";
  return "<h2>By how much &#8220;" + Escape(result.rows.back().row.title) +
         "&#8221; opens more often</h2>\n<table><thead><tr><th>than</th><th>points</th>"
         "<th>95 % interval</th><th>differs</th><th>fewer &#8592; opened, beside it &#8594; "
         "more</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n<p>Paired: the same doors and seeds. Bodies and handles are " +
         "resampled, both at a time; how trainings differ is not in the interval.</p>";
}

// Hue and dashes of a row's line: either alone tells neighbours apart.
std::string LineStyle(std::size_t row, std::size_t rows) {
  constexpr std::array<const char*, 3> kDashes = {"none", "8 4", "2 4"};
  return "stroke:hsl(" + std::to_string(360 * row / rows) +
         " 65% 50%);stroke-dasharray:" + kDashes[row % kDashes.size()];
}

std::string AngleFigure(const BenchmarkResult& result) {
  page::SvgPlot plot;
  plot.x_range = {0, 90};
  std::vector<page::PlotTick> shares;
  for (const int share : {0, 25, 50, 75, 100})
    shares.emplace_back(share / 100.0, std::to_string(share) + " %");
  std::vector<page::PlotTick> degrees;
  for (int degree = 0; degree <= 90; degree += 15)
    degrees.emplace_back(degree, std::to_string(degree) + "\u00b0");
  std::string svg = HorizontalGrid(plot, shares) + VerticalTicks(plot, degrees) +
                    AxisTitles(plot, "hinge's angle", "episodes that passed it");
  std::string legend;
  for (std::size_t i = 0; i < result.rows.size(); ++i) {
    const std::string style = " style=\"" + LineStyle(i, result.rows.size()) + "\"";
    page::PlotPoints points;
    for (const double share : result.rows[i].past_degree)
      points.emplace_back(static_cast<double>(points.size()), share);
    svg += "<g" + style + ">" + Line(plot, points, "") + "</g>";
    legend +=
        R"(<span><svg viewBox="0 0 34 12" aria-hidden="true"><path class="line" d="M1 6H33")" +
        style + "/></svg>" + Escape(result.rows[i].row.title) + "</span>\n";
  }
  return "<h2>How far doors came open</h2>\n" +
         SvgElement(plot, "Share of episodes whose hinge passed an angle, by row", svg) +
         "\n<div class=\"legend\">" + legend +
         "</div>\n<p>Mean of the categories. An episode ends where it has succeeded, beyond 45 "
         "degrees unless a row says otherwise.</p>";
}

std::string BudgetTable(const BenchmarkResult& result) {
  std::string rows;
  for (const BenchmarkRowResult& row : result.rows) {
    std::string links;
    for (const std::string& report : row.reports)
      links += "<a href=\"" + Escape(report) + "/report.html\">" +
               Escape(report.substr(report.rfind('/') + 1)) + "</a> ";
    rows += "<tr>" + Cell(Escape(row.row.title)) +
            Cell(row.row.pipeline.empty() ? "none" : Escape(row.row.pipeline)) +
            Cell(row.row.pipeline.empty() ? "&#8211;" : Fixed(row.train_minutes, 0)) + Cell(links) +
            "</tr>\n";
  }
  return "<h2>Budgets, and how each row fails</h2>\n<table><thead><tr><th>row</th>"
         "<th>pipeline</th><th>core minutes of a training, expected</th>"
         "<th>reports with films of every way to fail</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>";
}

}  // namespace

std::string BenchmarkPage(const BenchmarkResult& result) {
  const TrainingsSummary& first = result.rows.front().summary;
  const bool papers = std::ranges::any_of(
      result.benchmark.rows, [](const BenchmarkRow& row) { return !row.paper.empty(); });
  const bool composes = std::ranges::any_of(
      result.benchmark.rows, [](const BenchmarkRow& row) { return !row.compose.empty(); });
  return Fill(R"(<!DOCTYPE html>
<html lang="en" xmlns="http://www.w3.org/1999/xhtml">
<head>
<meta charset="utf-8"/>
<meta name="viewport" content="width=device-width, initial-scale=1"/>
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'"/>
<title>doorforge benchmark: {name}</title>
<style>{style}h2 { margin-top: 40px; }</style>
</head>
<body>
<header><h1>Benchmark &#8220;{name}&#8221;</h1>
<p>Share of doors opened beyond 45 degrees [%], with 95 % intervals by resampled bodies and handles; {doors} doors, {seeds} scenes each,
{same} for every row.{paper}</p></header>
<main>
{table}
{comparisons}
{angles}
{budgets}
</main>
<footer>Made by doorforge {version}. The same numbers for programs: benchmark.json beside this page.</footer>
</body>
</html>
)",
              {{"name", Escape(result.benchmark.name)},
               {"style", std::string(page::kPageStyle)},
               {"doors", std::to_string(first.doors)},
               {"seeds", std::to_string(result.benchmark.size.seeds)},
               {"same", composes ? "of the same bodies and handles" : "the same"},
               {"paper", papers ? kPaperNote : ""},
               {"table", SuccessTable(result)},
               {"comparisons", ComparisonTable(result)},
               {"angles", AngleFigure(result)},
               {"budgets", BudgetTable(result)},
               {"version", Escape(CodeVersion())}});
}

std::filesystem::path WriteBenchmark(const BenchmarkResult& result,
                                     const std::filesystem::path& folder) {
  CommitFile(folder / "benchmark.html", BenchmarkPage(result));
  WriteJsonFile(folder / "benchmark.json", BenchmarkToJson(result));
  return std::filesystem::absolute(folder / "benchmark.html").lexically_normal();
}

}  // namespace doorforge
