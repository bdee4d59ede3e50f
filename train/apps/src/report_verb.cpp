// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/verbs/report_verb.h"

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/program.h"
#include "doorforge/report/over_trainings.h"
#include "doorforge/report/report_folder.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  std::vector<fs::path> reports;
  bool json = false;
};

ReportOptions Parse(int argc, char** argv) {
  ReportOptions options;
  CLI::App app(
      "One table of the reports of several trainings, judged on the same doors and seeds: mean "
      "and\n"
      "spread over the trainings, and intervals by resampling bodies and handles.",
      "doorforge report");
  app.add_option("reports", options.reports, "folders of `doorforge eval --out`, or report.json")
      ->required()
      ->check(CLI::ExistingPath);
  AddJson(app, options.json);
  app.footer("example:\n  doorforge report run1/report run2/report run3/report");
  ParseVerb(app, argc, argv);
  return options;
}

}  // namespace

int RunReportVerb(int argc, char** argv) {
  return RunProgram([&] {
    const ReportOptions options = Parse(argc, argv);
    std::vector<EvaluationReport> reports;
    for (const fs::path& place : options.reports) reports.push_back(ReadReport(place));
    const TrainingsSummary summary = SummariseTrainings(reports);
    PrintAnswer(options.json, TrainingsToJson(summary), TrainingsTable(summary));
    return 0;
  });
}

}  // namespace doorforge
