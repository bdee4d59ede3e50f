// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "doorforge/cli/command_line.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/policy/familiarity.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/turned_classifier.h"
#include "doorforge/training/linear_algebra.h"
#include "doorforge/training/loss_files.h"
#include "doorforge/training/stage_dataset.h"
#include "doorforge/training/train_stage.h"
#include "doorforge/training/trainer_state_file.h"
#include "doorforge/training/training_page.h"

#include "verbs.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kCurvesPage = "training.html";

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
  app.add_option("stage", options.stage, "open, handle or grasp")
      ->required()
      ->check(CLI::IsMember({"open", "handle", "grasp"}));
  app.add_option("--data", options.data, "data set, or several of the same stage")
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
  app.add_option("--config", options.config, "YAML file with training settings")
      ->check(CLI::ExistingFile);
  AddSettings(app, options.settings, "overrides one setting");
  app.add_option("--seed", options.seed, "decides every random choice (config: seed)");
  app.add_option("--threads", options.threads, "threads, 0: all; the result does not depend on it")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--device", options.device,
                 "cpu, cuda or cuda:N, where libtorch has CUDA, or libtorch: its operators on the\n"
                 "processor (config: device)");
  app.add_flag("--resume", options.resume, "go on from the state in --out, if there is one");
  app.add_flag("--overwrite", options.overwrite, "start anew where --out holds a training");
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

void WarnOfSlowLinearAlgebra() {
  const LinearAlgebra found = MeasureLinearAlgebra();
  if (found.gflops >= kLeastGflops) return;
  std::fprintf(stderr,
               "doorforge: warning: libtorch multiplies matrices at %.1f GFLOP/s (%s); with "
               "OpenBLAS training is faster:\n%s\n",
               found.gflops,
               found.blas_library.empty() ? "an unknown library" : found.blas_library.c_str(),
               LinearAlgebraRemedy().c_str());
}

// libtorch's operators on the processor ask for gigabytes on every step: kept in the process they
// need not be cleared by the system each time, which takes a third of the time.
void KeepFreedMemory() {
#ifdef __GLIBC__
  ::mallopt(M_ARENA_MAX, 1);  // the other arenas cannot hold what is so large
  ::mallopt(M_MMAP_MAX, 0);
  ::mallopt(M_TRIM_THRESHOLD, -1);
  ::mallopt(M_TOP_PAD, 256 << 20);
#endif
}

// The losses in units that people think in; what is not known yet is left out.
std::string LossText(const StageLosses& losses, NetworkFamily family) {
  struct Shown {
    const char* format;
    double value;
  };
  const double to_degrees = 57.29578;
  const std::vector<Shown> motion = {{"position %.2f mm", 1e3 * losses.position_m},
                                     {"rotation %.2f deg", to_degrees * losses.rotation_rad},
                                     {"critic %.2f deg", to_degrees * losses.score_rad}};
  const std::vector<Shown> grasp = {{"discriminator %.2f deg", to_degrees * losses.score_rad},
                                    {"affordance %.2f deg", to_degrees * losses.affordance_rad}};
  std::string text;
  for (const Shown& shown : family == NetworkFamily::kGrasp ? grasp : motion) {
    if (std::isnan(shown.value)) continue;
    char part[64];
    std::snprintf(part, sizeof part, shown.format, shown.value);
    text += (text.empty() ? "" : ", ") + std::string(part);
  }
  return text;
}

std::string Note(const TrainerState& state, std::uint64_t per_epoch, const TrainConfig& config) {
  char text[80];
  std::snprintf(text, sizeof text, "samples; epoch %.1f/%d step %llu: ",
                static_cast<double>(state.step) / static_cast<double>(per_epoch), EpochsOf(config),
                static_cast<unsigned long long>(state.step));
  return text + LossText(state.steps.back(), config.family);
}

// What a training leaves for those who act by it.
struct PolicyOutput {
  fs::path folder;
  PolicyProvenance provenance;
  std::uint64_t steps_per_epoch;
  std::optional<TurnedClassifier> turned;
  std::optional<Familiarity> familiarity;
};

void WriteBesides(const PolicyOutput& output, const fs::path& folder) {
  WriteTurnedClassifier(folder, output.turned, output.provenance.dataset_sha256);
  WriteFamiliarity(folder, output.familiarity, output.provenance.dataset_sha256);
}

// Where both networks have been validated, what they were at their best: a policy below the last.
void WriteBest(const PolicyOutput& output, const BestNetworks& best) {
  const BestEpochs& epochs = best.epochs;
  if (epochs.actor == 0 || epochs.critic == 0) return;
  PolicyProvenance provenance = output.provenance;
  provenance.best = epochs;
  provenance.step =
      output.steps_per_epoch * static_cast<std::uint64_t>(std::max(epochs.actor, epochs.critic));
  WriteBesides(output, output.folder / "best");
  WritePolicy(output.folder / "best", best.networks, provenance);
}

// Only what WriteBest() writes: whatever else lies there is the user's.
void RemoveBest(const fs::path& out) {
  for (const char* file :
       {"policy.json", "policy.safetensors", "turned.safetensors", "familiar.safetensors"})
    fs::remove(out / "best" / file);
  if (fs::is_directory(out / "best") && fs::is_empty(out / "best")) fs::remove(out / "best");
}

// A folder that holds a training is only touched if the user said how.
void CheckFolder(const Options& options) {
  if (options.resume || options.overwrite) return;
  for (const char* file : {"training.safetensors", "policy.safetensors"}) {
    if (fs::exists(fs::path(options.out) / file))
      throw Error(ErrorCode::kInvalidArgument,
                  options.out +
                      ": holds a training already; pass --resume to go on, or "
                      "--overwrite to start anew");
  }
}

// For programs, TensorBoard and people.
void WriteCurves(const fs::path& out, const TrainerState& state, const TrainingRun& run) {
  WriteLosses(out, state, run.pace);
  CommitFile(out / kCurvesPage, TrainingPage(state, run));
}

// At "handle": of the decisions that turned the handle, how many it finds.
void PrintTurned(const StageDataset& dataset, const fs::path& out) {
  const auto classifier = ReadTurnedClassifier(out, dataset.content_sha256);
  if (!classifier || dataset.turned_validation.empty()) return;
  const TurnedAccuracy accuracy = MeasureTurned(*classifier, dataset.turned_validation);
  std::printf("turned:     %d of %d last actions told, %d of %d calls too early (validation)\n",
              accuracy.correct, accuracy.turned, accuracy.called - accuracy.correct,
              accuracy.called);
}

void PrintSummary(const TrainerState& state, const StageDataset& dataset, const Options& options) {
  std::printf("policy:     %s\n", fs::absolute(options.out).lexically_normal().c_str());
  std::printf("curves:     %s\n",
              fs::absolute(fs::path(options.out) / kCurvesPage).lexically_normal().c_str());
  std::printf("samples:    %zu for training, %zu for validation\n", dataset.train.size(),
              dataset.validation.size());
  PrintTurned(dataset, options.out);
  if (state.epochs.empty()) return;
  const EpochLosses& last = state.epochs.back();
  const NetworkFamily family = state.networks.family;
  std::printf("training:   %s\n", LossText(last.train, family).c_str());
  if (!dataset.validation.empty())
    std::printf("validation: %s\n", LossText(last.validation, family).c_str());
}

// The weights of another policy, which the record names.
void BeginWith(const Options& options, PolicyProvenance& provenance, TrainHooks& hooks) {
  PolicyRecord policy = ReadPolicy(options.from, options.stage);
  Require(policy.networks.linear_branches == provenance.config.linear_branches,
          ErrorCode::kInvalidArgument,
          options.from + ": was trained with another setting of linear_branches");
  provenance.from_weights_sha256 = policy.weights_sha256;
  provenance.trained_on = Union(provenance.trained_on, policy.provenance.trained_on);
  hooks.initial = std::move(policy.networks);
}

// Writes the policy of the last epoch whose state is on disk, and says so; nothing without one.
std::string KeepLastGood(const fs::path& out, PolicyProvenance provenance) {
  if (!HasTrainerState(out)) return "";
  TrainerState state;
  try {
    state = ReadTrainerState(out, provenance);
  } catch (const Error&) {  // of an earlier run, which this one was to replace
    return "";
  }
  provenance.step = state.step;
  WritePolicy(out, PolicyOf(state), provenance);
  return "\n" + out.string() + " holds the policy and the state as they were after step " +
         std::to_string(state.step) + ", the last whose epoch ended well";
}

int Train(const Options& options) {
  const fs::path out = options.out;
  const TrainConfig config = ConfigOf(options);
  if (config.device == "libtorch" || NormOf(config) == EncoderNorm::kBatch) KeepFreedMemory();
  const auto group = options.nodes ? ProcessGroupFromEnvironment() : SoleProcess();
  const bool first = group->rank() == 0;  // which alone writes
  std::optional<FolderLock> lock;
  if (first) {
    // who writes there now is told first: what there is would be half of the answer
    lock.emplace(out, "doorforge train", Writers::kOne);
    CheckFolder(options);
    RemoveStaleFiles(SystemFiles(), out);
  }
  WarnOfSlowLinearAlgebra();
  const std::vector<fs::path> folders(options.data.begin(), options.data.end());
  const StageDataset dataset = ReadStageDataset(folders, options.stage, config.validation_share);
  PolicyProvenance provenance{options.stage, dataset.content_sha256, CodeVersion(), config, 0, "",
                              dataset.parts};

  TrainHooks hooks;
  hooks.threads = options.threads;
  hooks.group = group.get();
  hooks.check_samples = [&] { dataset.RequireWhole(); };
  if (!options.from.empty()) BeginWith(options, provenance, hooks);
  if (options.resume && HasTrainerState(out)) hooks.resume = ReadTrainerState(out, provenance);
  const std::uint64_t per_epoch = StepsPerEpoch(dataset.train.size(), config);
  const TrainingRun run{
      provenance, {config, per_epoch}, dataset.train.size(), dataset.validation.size()};
  PolicyOutput output{out, provenance, per_epoch, {}, {}};
  if (first) {
    CommitFile(out / "config.yaml", JsonText(ToJson(config), 2) + "\n");
    output.turned = FitTurnedClassifier(dataset.turned_train);
    output.familiarity = FitFamiliarity(dataset.train, dataset.validation, config.family);
    WriteBesides(output, out);
    if (!hooks.resume) RemoveBest(out);  // of an earlier training
  }

  const std::uint64_t total = per_epoch * static_cast<std::uint64_t>(EpochsOf(config));
  const std::uint64_t done = hooks.resume ? hooks.resume->step : 0;
  const std::size_t batch =
      std::min(dataset.train.size(), static_cast<std::size_t>(config.batch_size));
  const auto start = Clock::now();
  TrainerState state;
  {
    std::optional<Progress> progress;
    if (first) {
      progress.emplace("train " + options.stage,
                       static_cast<std::size_t>(total - std::min(done, total)) * batch);
      hooks.on_step = [&](const TrainerState& now) {
        progress->Advance(batch, Note(now, per_epoch, config));
      };
      hooks.on_epoch = [&](const TrainerState& now) {
        WriteTrainerState(out, now, provenance);
        WriteCurves(out, now, run);
        WriteBest(output, now.best);
      };
    }
    hooks.stop = [&] {
      const std::chrono::duration<double> elapsed = Clock::now() - start;
      return StopRequested() != 0 ||
             (options.minutes > 0 && elapsed.count() > 60 * options.minutes);
    };
    try {
      state = TrainStage(dataset.train, dataset.validation, config, hooks);
    } catch (const Error& error) {
      dataset.RequireWhole();  // zeros in place of clouds make losses that are no numbers
      if (!first || error.code() != ErrorCode::kIncomplete) throw;
      throw Error(error.code(), error.what() + KeepLastGood(out, provenance));
    }
  }
  if (!first) return state.step < total && StopRequested() != 0 ? 128 + StopRequested() : 0;
  WriteTrainerState(out, state, provenance);
  WriteCurves(out, state, run);
  WriteBest(output, state.best);
  const bool finished = state.step >= total;
  if (!finished)
    std::fprintf(stderr, "doorforge: stopped after %llu of %llu steps; --resume goes on\n",
                 static_cast<unsigned long long>(state.step),
                 static_cast<unsigned long long>(total));
  if (!finished && StopRequested() != 0) return 128 + StopRequested();
  provenance.step = state.step;
  WritePolicy(out, PolicyOf(state), provenance);
  PrintSummary(state, dataset, options);
  return 0;
}

}  // namespace

int RunTrainVerb(int argc, char** argv) {
  const Options options = Parse(argc, argv);
  return NamingConfig(options.config, [&] { return Train(options); });
}

}  // namespace doorforge
