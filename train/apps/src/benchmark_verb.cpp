// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/verbs/benchmark_verb.h"

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/benchmark/benchmark_page.h"
#include "doorforge/benchmark/benchmark_pipeline.h"
#include "doorforge/benchmark/benchmark_result.h"
#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/program.h"
#include "doorforge/pipeline/pipeline_run.h"

namespace doorforge {
namespace {

struct BenchmarkOptions {
  std::vector<std::string> size;  // "plan" may come before it
  std::vector<std::string> rows;
  std::vector<std::string> doors;
  std::vector<std::string> settings;
  PipelineRun run;
  bool dry_run = false;
};

BenchmarkOptions ParseBenchmark(int argc, char** argv) {
  BenchmarkOptions options;
  CLI::App app(
      "The paper's table in one simulator: trains what is missing, evaluates every row on the "
      "same\ndoors and seeds, and ends in one page. A step is skipped while nothing that it was "
      "made from\nhas changed; stopped, the same command goes on.",
      "doorforge benchmark");
  app.add_option("size", options.size,
                 "quick, paper, robustness, simulators, a .yaml file; after `plan`: as --dry-run")
      ->required()
      ->expected(1, 2);
  app.add_option("--out", options.run.out, "folder for everything that is made")->required();
  app.add_option("--rows", options.rows, "the rows to judge, in place of the size's");
  app.add_option("--doors", options.doors, "folders of composed doors, instead of the catalogue's");
  AddThreads(app, options.run.threads, "threads, 0: all; changes no byte")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  AddSettings(app, options.settings, "changes the size, e.g. doors=12");
  app.add_flag("--dry-run", options.dry_run, "print steps, reasons, time and space");
  AddJson(app, options.run.json, "print one JSON document, of the plan or of the result");
  AddOverwrite(app, options.run.overwrite, "replace what was made of other inputs");
  app.add_flag("--any-build", options.run.any_build, "keep steps of other builds");
  app.footer("sizes:\n" + SizesText() +
             "\nexamples:\n"
             "  doorforge benchmark plan quick --out run/benchmark\n"
             "  doorforge benchmark quick --out run/benchmark --rows expert gapartnet ours\n"
             "  doorforge benchmark robustness --out run/card --set doors=4");
  ParseVerb(app, argc, argv);
  if (TakePlan(options.size)) options.dry_run = true;
  return options;
}

int RunBenchmark(BenchmarkOptions& options) {
  const Benchmark benchmark = ReadBenchmark(options.size[0], options.settings, options.rows);
  BenchmarkPlan plan = PlanBenchmark(benchmark);
  if (!options.doors.empty()) GiveDoors(benchmark, options.doors, plan);
  if (options.dry_run) {
    PrintText(PlanPipeline(plan.pipeline, options.run));
    return 0;
  }
  options.run.progress = PrintProgress;
  if (const int code = RunPipeline(plan.pipeline, options.run); code != 0) return code;
  const BenchmarkResult result = ReadBenchmarkResult(benchmark, plan, options.run.out);
  const std::string page = WriteBenchmark(result, options.run.out).string();
  PrintAnswer(options.run.json, BenchmarkToJson(result),
              BenchmarkText(result) + "\npage: " + page + "\n");
  return 0;
}

}  // namespace

int RunBenchmarkVerb(int argc, char** argv) {
  return RunProgram([&] {
    BenchmarkOptions options = ParseBenchmark(argc, argv);
    return RunBenchmark(options);
  });
}

}  // namespace doorforge
