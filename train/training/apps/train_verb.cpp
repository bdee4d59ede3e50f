// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/program.h"
#include "doorforge/training/train_folder.h"

#include "verbs.h"

namespace doorforge {
namespace {

struct Options {
  TrainingRequest request;
  std::string config;
  std::vector<std::string> settings;
  std::optional<int> epochs;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> device;
};

Options Parse(int argc, char** argv) {
  Options options;
  CLI::App app("Trains a stage's policy from the shards of `doorforge datagen`.",
               "doorforge train");
  app.add_option("stage", options.request.stage,
                 "open, handle or grasp; motion: one policy of open and handle; find: a finder of "
                 "handles")
      ->required()
      ->check(CLI::IsMember({"open", "handle", "grasp", "motion", "find"}));
  app.add_option("--data", options.request.data,
                 "data set, or several of the same stage; of motion: of either")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_option("--from", options.request.from,
                 "begin with the weights and the normalisation of this trained policy")
      ->check(CLI::ExistingDirectory);
  app.add_option("--out", options.request.out, "folder of the policy")->required();
  app.add_option("--epochs", options.epochs,
                 "passes over the samples, for each of the two networks of grasp (config: epochs)");
  app.add_option("--minutes", options.request.minutes,
                 "stop after this time, at the end of a step; --resume goes on")
      ->check(CLI::PositiveNumber);
  AddConfig(app, options.config, "YAML file with training settings")->check(CLI::ExistingFile);
  AddSettings(app, options.settings, "overrides one setting");
  app.add_option("--seed", options.seed, "decides every random choice (config: seed)");
  AddThreads(app, options.request.threads, "threads, 0: all; the result does not depend on it");
  app.add_option("--device", options.device,
                 "cpu, cuda or cuda:N, where libtorch has CUDA, or libtorch: its operators on the\n"
                 "processor (config: device)");
  app.add_flag("--resume", options.request.resume,
               "go on from the state in --out, if there is one");
  AddOverwrite(app, options.request.overwrite, "start anew where --out holds a training");
  app.add_flag("--nodes", options.request.nodes,
               "one of 2, 4 or 8 processes that share the batches: RANK, WORLD_SIZE, MASTER_ADDR\n"
               "and MASTER_PORT say which, as torchrun sets them; the result is that of one. They\n"
               "talk in clear text and ask nobody who he is: for a network that you trust alone");
  app.footer(
      "Writes policy.safetensors and policy.json (the policy), best/ (as it was when it erred "
      "least\n"
      "on the validation set), training.html (the curves and\n"
      "settings, to look at while it runs), losses.jsonl, losses.json and an event file for\n"
      "TensorBoard (the same for programs), config.yaml and training.safetensors (what\n"
      "--resume reads).\n\n"
      "examples:\n"
      "  doorforge train open --data run/data --out run/policy --epochs 10 --set batch_size=32\n"
      "  torchrun --nproc-per-node 2 --no-python doorforge train open --data run/data \\\n"
      "      --out run/policy --threads 1 --nodes");
  ParseVerb(app, argc, argv);
  return options;
}

TrainConfig ConfigOf(const Options& options) {
  auto config = LoadConfig<TrainConfig>(options.config, options.settings,
                                        TrainDefaultsOf(options.request.stage));
  if (options.epochs) config.epochs = *options.epochs;
  if (options.seed) config.seed = *options.seed;
  if (options.device) config.device = *options.device;
  CheckTrainConfig(config);
  return config;
}

int Train(TrainingRequest request) {
  request.warn = [](const std::string& warning) { PrintNote("warning: " + warning); };
  const TrainingOutcome outcome = TrainIntoFolder(request);
  const bool finished = outcome.steps_done >= outcome.steps_total;
  if (outcome.writes && !finished)
    PrintNote("stopped after " + std::to_string(outcome.steps_done) + " of " +
              std::to_string(outcome.steps_total) + " steps; --resume goes on");
  if (!finished && StopRequested() != 0) return 128 + StopRequested();
  if (outcome.writes) PrintText(OutcomeText(outcome, request));
  return 0;
}

}  // namespace

int RunTrainVerb(int argc, char** argv) {
  Options options = Parse(argc, argv);
  return NamingConfig(options.config, [&] {
    options.request.config = ConfigOf(options);
    return Train(options.request);
  });
}

}  // namespace doorforge
