// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The program that trains policies of the whole episode.

#include <CLI/CLI.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/cli/verb_table.h"
#include "doorforge/core/environment_preset.h"
#include "doorforge/core/program.h"
#include "doorforge/reinforce/reinforce.h"

namespace doorforge {
namespace {

void Parse(int argc, char** argv, ConfigSources& config, ReinforceRequest& request) {
  CLI::App app("Trains a policy of the whole episode, by PPO or else.", "doorforge reinforce");
  app.add_option("--doors", request.doors,
                 "folders of composed doors; with a split such as full:train only its doors")
      ->required();
  app.add_option("--out", request.out, "folder of the policy")->required();
  app.add_option("--teacher", request.teacher, "a policy of true states, for one that looks");
  app.add_option("--features", request.features, "a policy that looks, to act on its features");
  app.add_flag("--trajectories", request.trajectories, "for an arm that replays what it decided");
  app.add_option("--decisions", request.decisions, "of all steppers (config: ppo.decisions)");
  app.add_option("--rounds", request.rounds, "of --teacher and --trajectories");
  app.add_option("--minutes", request.minutes, "stop after so many")->check(CLI::PositiveNumber);
  AddPreset(app, config.preset);
  AddConfig(app, config.file, "YAML file with settings")->check(CLI::ExistingFile);
  AddSettings(app, config.settings, "a.b=c overrides one setting");
  app.add_option("--seed", request.seed, "of every random choice (config: ppo.seed and so on)");
  AddThreads(app, request.threads, "0: all processors; the result does not depend on it");
  app.add_flag("--resume", request.resume, "go on from the state in --out, if there is one");
  AddOverwrite(app, request.overwrite, "start anew where --out holds a training");
  app.footer(
      "Writes the policy, for --whole of `eval`, training.html (curves) and what --resume "
      "reads.\n\nexample:\n  doorforge reinforce --preset doorgym --doors run/doors --out "
      "run/ppo --decisions 1000000");
  ParseVerb(app, argc, argv);
}

int RunReinforceVerb(int argc, char** argv) {
  ConfigSources config;
  ReinforceRequest request;
  Parse(argc, argv, config, request);
  const auto done = NamingConfig(config.Named(), [&] { return Reinforce(request, config); });
  PrintText(done.text);
  return !done.finished && StopRequested() != 0 ? 128 + StopRequested() : 0;
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunOneVerb({"reinforce", doorforge::RunReinforceVerb}, argc, argv);
}
