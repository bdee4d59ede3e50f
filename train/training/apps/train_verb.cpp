// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/program.h"
#include "doorforge/training/train_folder.h"

#include "verbs.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string stage;
  std::vector<std::string> data;
  std::string from;
  std::string out;
  std::string config;
  std::vector<std::string> settings;
  std::optional<int> epochs;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> device;
  double minutes = 0;
  int threads = 0;
  bool resume = false;
  bool overwrite = false;
  bool nodes = false;
};

Options Parse(int argc, char** argv) {
  Options options;
  CLI::App app("Trains a stage's policy from the shards of `doorforge datagen`.",
               "doorforge train");
  app.add_option("stage", options.stage,
                 "open, handle or grasp; motion: one policy of the data of open and handle")
      ->required()
      ->check(CLI::IsMember({"open", "handle", "grasp", "motion"}));
  app.add_option("--data", options.data,
                 "data set, or several of the same stage; of motion: of either")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_option("--from", options.from,
                 "begin with the weights and the normalisation of this trained policy")
      ->check(CLI::ExistingDirectory);
  app.add_option("--out", options.out, "folder of the policy")->required();
  app.add_option("--epochs", options.epochs,
                 "passes over the samples, for each of the two networks of grasp (config: epochs)");
  app.add_option("--minutes", options.minutes,
                 "stop after this time, at the end of a step; --resume goes on")
      ->check(CLI::PositiveNumber);
  AddConfig(app, options.config, "YAML file with training settings")->check(CLI::ExistingFile);
  AddSettings(app, options.settings, "overrides one setting");
  app.add_option("--seed", options.seed, "decides every random choice (config: seed)");
  AddThreads(app, options.threads, "threads, 0: all; the result does not depend on it")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--device", options.device,
                 "cpu, cuda or cuda:N, where libtorch has CUDA, or libtorch: its operators on the\n"
                 "processor (config: device)");
  app.add_flag("--resume", options.resume, "go on from the state in --out, if there is one");
  AddOverwrite(app, options.overwrite, "start anew where --out holds a training");
  app.add_flag("--nodes", options.nodes,
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
  TrainConfig defaults;
  defaults.family = FamilyOf(options.stage);
  auto config = LoadConfig<TrainConfig>(options.config, options.settings, defaults);
  if (options.epochs) config.epochs = *options.epochs;
  if (options.seed) config.seed = *options.seed;
  if (options.device) config.device = *options.device;
  CheckTrainConfig(config);
  return config;
}

TrainingRequest RequestOf(const Options& options) {
  TrainingRequest request{.stage = options.stage,
                          .data = {options.data.begin(), options.data.end()},
                          .from = options.from,
                          .out = options.out,
                          .config = ConfigOf(options)};
  request.minutes = options.minutes;
  request.threads = options.threads;
  request.resume = options.resume;
  request.overwrite = options.overwrite;
  request.nodes = options.nodes;
  request.warn = [](const std::string& warning) {
    std::fprintf(stderr, "doorforge: warning: %s\n", warning.c_str());
  };
  return request;
}

void PrintSummary(const TrainingOutcome& outcome, const TrainingRequest& request) {
  std::printf("policy:     %s\n", fs::absolute(request.out).lexically_normal().c_str());
  std::printf("curves:     %s\n",
              fs::absolute(request.out / kCurvesPage).lexically_normal().c_str());
  std::printf("samples:    %zu for training, %zu for validation\n", outcome.train_samples,
              outcome.validation_samples);
  if (const auto& turned = outcome.turned)
    std::printf("turned:     %d of %d last actions told, %d of %d calls too early (validation)\n",
                turned->correct, turned->turned, turned->called - turned->correct, turned->called);
  if (!outcome.last_epoch) return;
  const NetworkFamily family = request.config.family;
  std::printf("training:   %s\n", LossText(outcome.last_epoch->train, family).c_str());
  if (outcome.validation_samples > 0)
    std::printf("validation: %s\n", LossText(outcome.last_epoch->validation, family).c_str());
}

int Train(const Options& options) {
  const TrainingRequest request = RequestOf(options);
  const TrainingOutcome outcome = TrainIntoFolder(request);
  const bool finished = outcome.steps_done >= outcome.steps_total;
  if (outcome.writes && !finished)
    std::fprintf(stderr, "doorforge: stopped after %llu of %llu steps; --resume goes on\n",
                 static_cast<unsigned long long>(outcome.steps_done),
                 static_cast<unsigned long long>(outcome.steps_total));
  if (!finished && StopRequested() != 0) return 128 + StopRequested();
  if (outcome.writes) PrintSummary(outcome, request);
  return 0;
}

}  // namespace

int RunTrainVerb(int argc, char** argv) {
  const Options options = Parse(argc, argv);
  return NamingConfig(options.config, [&] { return Train(options); });
}

}  // namespace doorforge
