// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/verbs/eval_verb.h"

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/environment_preset.h"
#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/evaluate/evaluation_folder.h"
#include "doorforge/registry/policy_options.h"
#include "doorforge/remote/remote_options.h"
#include "doorforge/report/report_table.h"

namespace doorforge {
namespace {

struct Options {
  EvaluationRequest request;
  RemoteOptions remote;
  std::vector<std::string> doors;
  std::string split;
  int per_category = 0;
  std::string out;
  ConfigSources config;
  std::optional<SwitchSource> unlock_switch;
  std::optional<int> seeds;
  std::optional<std::uint64_t> first_seed;
  std::optional<int> episodes_per_door;
  Existing existing = Existing::kRefuse;
  bool json = false;
};

void AddOptions(CLI::App& app, Options& options) {
  EvaluationRequest& request = options.request;
  AddPolicyOptions(app, request.registry, request.policies);
  AddRemoteOptions(app, options.remote);
  app.add_option(
         "--doors", options.doors,
         "folders of composed doors, searched in depth; with a split such as full:test only "
         "its doors")
      ->required();
  app.add_option("--split", options.split, "the same: a split and its side, such as full:test");
  app.add_option("-n,--per-category", options.per_category,
                 "at most so many doors of each category, all handles and bodies as evenly as "
                 "the number allows; 0: all")
      ->check(CLI::NonNegativeNumber);
  auto* out = app.add_option(
      "--out", options.out,
      "folder for report.json and report.html; without it only the table is printed");
  app.add_option("--data", options.request.data,
                 "data sets that the opener was trained from: the report lists and shows their "
                 "doors");
  AddChoice(app, "--switch", options.unlock_switch,
            "who says that the handle is turned: a trained handler itself "
            "(predicted), or the simulator (privileged); (config: switch, predicted)");
  app.add_option("--seeds", options.seeds, "repetitions with other scenes (config: seeds, 3)");
  app.add_option("--seed", options.first_seed, "the first of them (config: first_seed, 1)");
  app.add_option("--episodes-per-door", options.episodes_per_door,
                 "in each seed (config: episodes_per_door, 1)");
  AddThreads(app, options.request.threads, "0: all processors; the result does not depend on it");
  AddEnvironment(app, options.config);
  AddConfig(app, options.config.file, "YAML file with settings")->check(CLI::ExistingFile);
  AddSettings(app, options.config.settings, "a.b=c overrides one setting");
  app.add_flag("--allow-seen", options.request.allow_seen,
               "evaluate on doors with parts that the policy was trained on, too");
  app.add_flag("--films", options.request.films,
               "with --out: run every failure once more and keep its course in films.jsonl, with "
               "films.html to look at it and links from report.html")
      ->needs(out);
  AddJson(app, options.json, "print report.json's document instead of a table");
  AddOverwrite(app, options.existing, "replace the report in --out");
}

Options Parse(int argc, char** argv, const EvalVerbSetup& setup) {
  Options options;
  options.request.registry = setup.registry;
  options.request.policies.opener = setup.opener;
  CLI::App app(
      "Success of policies in closed loop: one takes hold, one turns the handle, one opens; the\n"
      "expert stands in wherever nobody else is named.\n"
      "Prints success with 95 % intervals per category, causes of failure, and writes a report.",
      setup.program);
  AddOptions(app, options);
  const std::string line = "\n  " + setup.program + " --doors run/doors/test --opener ";
  app.footer("examples:" + line +
             "run/opener --handler run/handler --grasper run/grasper --out run/report" + line +
             "run/opener --data run/data --out run/report" + line +
             "expert --split full:test -n 50");
  ParseVerb(app, argc, argv);
  UseRemotePolicies(options.remote, setup.opener, options.request.registry,
                    options.request.policies);
  Require(!options.request.policies.opener.empty() || !options.request.policies.whole.empty(),
          ErrorCode::kInvalidArgument,
          "--opener is required: " + setup.registry.Choices(Stage::kOpen) + "; see `" +
              setup.program + " --help`");
  return options;
}

EvaluationConfig ConfigOf(const Options& options) {
  auto config = LoadConfig<EvaluationConfig>(options.config);
  if (options.unlock_switch) config.unlock_switch = *options.unlock_switch;
  Require(options.unlock_switch != SwitchSource::kPolicy ||
              options.request.policies.handler != kExpertPolicy,
          ErrorCode::kInvalidArgument,
          "--switch predicted: a policy that turns the handle says when it is turned; give one "
          "with --handler");
  if (options.seeds) config.seeds = *options.seeds;
  if (options.first_seed) config.first_seed = *options.first_seed;
  if (options.episodes_per_door) config.episodes_per_door = *options.episodes_per_door;
  return config;
}

int Evaluate(const Options& options) {
  EvaluatedFolder done;
  try {
    done = EvaluateIntoFolder(options.request, options.out, options.existing);
  } catch (const Error&) {
    if (StopRequested() == 0) throw;
    PrintNote("interrupted; nothing was written");
    return 128 + StopRequested();
  }
  for (const std::string& note : done.notes) PrintProgress(note + "\n");
  const EvaluationReport& report = done.evaluation.report;
  PrintAnswer(options.json, ReportToJson(report), ReportTable(report));
  return done.code;
}

}  // namespace

int RunEvalVerb(int argc, char** argv, const EvalVerbSetup& setup) {
  return RunProgram([&] {
    Options options = Parse(argc, argv, setup);
    options.request.config = ConfigOf(options);
    options.request.doors = DoorSelectionOf(options.doors, "test", options.split);
    options.request.doors.per_category = options.per_category;
    options.request.command = CommandLineText(setup.program, argc, argv);
    return NamingConfig(options.config.Named(), [&] { return Evaluate(options); });
  });
}

}  // namespace doorforge
