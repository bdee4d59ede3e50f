// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/error.h"
#include "doorforge/pipeline/pipeline_graph.h"
#include "doorforge/pipeline/pipeline_run.h"

#include "verbs.h"

namespace doorforge {
namespace {

struct Options {
  std::vector<std::string> preset;  // "plan" may come before it
  std::vector<std::string> doors;
  std::vector<std::string> settings;
  PipelineRun run;
  bool dry_run = false;
};

void ParseOptions(int argc, char** argv, Options& options) {
  CLI::App app(
      "The conditioned chain: collect and train a stage, then the one before it with what was\n"
      "trained in the loop, then evaluate. A step is skipped while nothing that it was made from\n"
      "has changed; stopped, the same command goes on.",
      "doorforge pipeline");
  app.add_option("preset", options.preset,
                 "a preset, or a .yaml file; with `plan` before it: as --dry-run")
      ->required()
      ->expected(1, 2);
  app.add_option("--out", options.run.out, "folder for everything that is made")->required();
  app.add_option("--doors", options.doors, "folders of composed doors, instead of the catalogue's");
  AddThreads(app, options.run.threads, "threads, 0: all; changes no byte");
  AddSettings(app, options.settings, "changes one of the preset's settings");
  app.add_flag("--dry-run", options.dry_run,
               "print the steps, why each would run, and the expected time and space");
  AddJson(app, options.run.json, "the plan as one JSON document");
  AddOverwrite(app, options.run.overwrite,
               "replace what steps made whose inputs have changed since");
  app.add_flag(
      "--any-build", options.run.any_build,
      "keep finished steps of other builds where nothing else has changed; each policy and\n"
      "data set names the build that made it");
  app.footer("presets:\n" + PresetsText() +
             "\nexamples:\n"
             "  doorforge pipeline plan quick --out run/quick\n"
             "  doorforge pipeline quick --out run/quick\n"
             "  doorforge pipeline paper --out run/paper --doors run/doors --set open_epochs=8");
  ParseVerb(app, argc, argv);
  if (TakePlan(options.preset)) options.dry_run = true;
  Require(options.dry_run || !options.run.json, ErrorCode::kInvalidArgument,
          "--json: belongs to `pipeline plan`");
}

}  // namespace

int RunPipelineVerb(int argc, char** argv) {
  Options options;
  options.run.progress = PrintProgress;
  options.run.result = PrintText;
  ParseOptions(argc, argv, options);
  Pipeline pipeline = ReadPipeline(options.preset[0], options.settings);
  if (!options.doors.empty()) GiveOutput(pipeline, "doors", options.doors);
  if (!options.dry_run) return RunPipeline(pipeline, options.run);
  PrintText(PlanPipeline(pipeline, options.run));
  return 0;
}

}  // namespace doorforge
