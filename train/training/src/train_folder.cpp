// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/training/train_folder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/policy/door_height.h"
#include "doorforge/policy/familiarity.h"
#include "doorforge/policy/policy_file.h"
#include "doorforge/policy/side_classifier.h"
#include "doorforge/training/linear_algebra.h"
#include "doorforge/training/loss_files.h"
#include "doorforge/training/stage_dataset.h"
#include "doorforge/training/trainer_state_file.h"
#include "doorforge/training/training_page.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::string SlowLinearAlgebra() {
  const LinearAlgebra found = MeasureLinearAlgebra();
  if (found.gflops >= kLeastGflops) return "";
  char speed[32];
  std::snprintf(speed, sizeof speed, "%.1f", found.gflops);
  return std::string("libtorch multiplies matrices at ") + speed + " GFLOP/s (" +
         (found.blas_library.empty() ? "an unknown library" : found.blas_library) +
         "); with OpenBLAS training is faster:\n" + LinearAlgebraRemedy();
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
  std::optional<SideClassifier> side;
  std::optional<LearnedHeights> heights;
};

void WriteBesides(const PolicyOutput& output, const fs::path& folder) {
  WriteTurnedClassifier(folder, output.turned, output.provenance.dataset_sha256);
  WriteFamiliarity(folder, output.familiarity, output.provenance.dataset_sha256);
  WriteSideClassifier(folder, output.side, output.provenance.dataset_sha256);
  WriteHeights(folder, output.heights, output.provenance.dataset_sha256);
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
  for (const char* file : {"policy.json", "policy.safetensors", "turned.safetensors",
                           "familiar.safetensors", "side.safetensors", "heights.safetensors"})
    fs::remove(out / "best" / file);
  if (fs::is_directory(out / "best") && fs::is_empty(out / "best")) fs::remove(out / "best");
}

// A folder that holds a training is only touched if the user said how.
void CheckFolder(const TrainingRequest& request) {
  if (request.resume || request.overwrite) return;
  for (const char* file : {"training.safetensors", "policy.safetensors"}) {
    if (fs::exists(request.out / file))
      throw Error(ErrorCode::kInvalidArgument,
                  request.out.string() +
                      ": holds a training already; pass --resume to go on, or "
                      "--overwrite to start anew");
  }
}

// For programs, TensorBoard and people.
void WriteCurves(const fs::path& out, const TrainerState& state, const TrainingRun& run) {
  WriteLosses(out, state, run.pace);
  CommitFile(out / kCurvesPage, TrainingPage(state, run));
}

// The weights of another policy, which the record names.
void BeginWith(const TrainingRequest& request, PolicyProvenance& provenance, TrainHooks& hooks) {
  PolicyRecord policy = ReadPolicy(request.from, request.stage);
  Require(policy.networks.linear_branches == provenance.config.linear_branches,
          ErrorCode::kInvalidArgument,
          request.from.string() + ": was trained with another setting of linear_branches");
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

std::optional<TurnedAccuracy> AccuracyOfTurned(const StageDataset& dataset, const fs::path& out) {
  const auto classifier = ReadTurnedClassifier(out, dataset.content_sha256);
  if (!classifier || dataset.turned_validation.empty()) return std::nullopt;
  return MeasureTurned(*classifier, dataset.turned_validation);
}

/// A training in its folder. Only the first process of a group writes.
class FolderTraining {
 public:
  FolderTraining(const TrainingRequest& request, ProcessGroup& group, const StageDataset& dataset)
      : request_(request),
        dataset_(dataset),
        first_(group.rank() == 0),
        provenance_{request.stage, dataset.content_sha256, CodeVersion(), request.config, 0, "",
                    dataset.parts},
        per_epoch_(StepsPerEpoch(dataset.train.size(), request.config)),
        total_(per_epoch_ * static_cast<std::uint64_t>(EpochsOf(request.config))) {
    hooks_.threads = request.threads;
    hooks_.group = &group;
    hooks_.check_samples = [this] { dataset_.RequireWhole(); };
  }

  TrainingOutcome Run() {
    if (!request_.from.empty()) BeginWith(request_, provenance_, hooks_);
    if (request_.resume && HasTrainerState(request_.out))
      hooks_.resume = ReadTrainerState(request_.out, provenance_);
    if (first_) Prepare();
    const TrainerState state = Train();
    if (first_) Finish(state);
    TrainingOutcome outcome{.writes = first_,
                            .steps_done = state.step,
                            .steps_total = total_,
                            .train_samples = dataset_.train.size(),
                            .validation_samples = dataset_.validation.size()};
    if (first_) outcome.turned = AccuracyOfTurned(dataset_, request_.out);
    if (!state.epochs.empty()) outcome.last_epoch = state.epochs.back();
    return outcome;
  }

 private:
  // what lies beside the networks is known before they are trained
  void Prepare() {
    output_ = {request_.out, provenance_, per_epoch_, {}, {}, {}, {}};
    CommitFile(request_.out / "config.yaml", JsonText(ToJson(request_.config), 2) + "\n");
    output_.turned = FitTurnedClassifier(TurnedExamples());
    output_.side = FitSideClassifier(dataset_.sides);
    output_.heights = FitHeights(dataset_.heights_m);
    if (request_.config.family != NetworkFamily::kFind)
      output_.familiarity = FitFamiliarity(
          dataset_.train, dataset_.validation, request_.config.family,
          request_.config.augment_mirror ? SampleSides::kMirroredToo : SampleSides::kAsSeen);
    WriteBesides(output_, request_.out);
    if (!hooks_.resume) RemoveBest(request_.out);  // of an earlier training
  }

  // With mirror images where the policy learns from them as well.
  std::vector<TurnedExample> TurnedExamples() const {
    std::vector<TurnedExample> examples = dataset_.turned_train;
    if (!request_.config.augment_mirror) return examples;
    for (const TurnedExample& example : dataset_.turned_train)
      examples.push_back({MirroredSideways(example.motion), example.turned});
    return examples;
  }

  // what an interruption must not take away
  void WriteState(const TrainerState& state) const {
    const TrainingRun run{provenance_,
                          {request_.config, per_epoch_},
                          dataset_.train.size(),
                          dataset_.validation.size()};
    WriteTrainerState(request_.out, state, provenance_);
    WriteCurves(request_.out, state, run);
    WriteBest(output_, state.best);
  }

  void ShowProgress(std::optional<Progress>& progress) {
    const std::uint64_t done = hooks_.resume ? hooks_.resume->step : 0;
    const std::size_t batch =
        std::min(dataset_.train.size(), static_cast<std::size_t>(request_.config.batch_size));
    progress.emplace("train " + request_.stage,
                     static_cast<std::size_t>(total_ - std::min(done, total_)) * batch);
    hooks_.on_step = [&progress, batch, this](const TrainerState& now) {
      progress->Advance(batch, Note(now, per_epoch_, request_.config));
    };
    hooks_.on_epoch = [this](const TrainerState& now) { WriteState(now); };
  }

  TrainerState Train() {
    std::optional<Progress> progress;
    if (first_) ShowProgress(progress);
    hooks_.stop = [start = Clock::now(), minutes = request_.minutes] {
      const std::chrono::duration<double> elapsed = Clock::now() - start;
      return StopRequested() != 0 || (minutes > 0 && elapsed.count() > 60 * minutes);
    };
    try {
      return TrainStage(dataset_.train, dataset_.validation, request_.config, hooks_);
    } catch (const Error& error) {
      dataset_.RequireWhole();  // zeros in place of clouds make losses that are no numbers
      if (!first_ || error.code() != ErrorCode::kIncomplete) throw;
      throw Error(error.code(), error.what() + KeepLastGood(request_.out, provenance_));
    }
  }

  void Finish(const TrainerState& state) {
    WriteState(state);
    if (state.step < total_ && StopRequested() != 0) return;
    provenance_.step = state.step;
    WritePolicy(request_.out, PolicyOf(state), provenance_);
  }

  const TrainingRequest& request_;
  const StageDataset& dataset_;
  bool first_;
  PolicyProvenance provenance_;
  std::uint64_t per_epoch_;
  std::uint64_t total_;
  PolicyOutput output_ = {};
  TrainHooks hooks_;
};

}  // namespace

std::string LossText(const StageLosses& losses, NetworkFamily family) {
  struct Shown {
    const char* format;
    double unit;
    std::optional<double> value;
  };
  const double to_degrees = 57.29578;
  const std::vector<Shown> motion = {{"position %.2f mm", 1e3, losses.position_m},
                                     {"rotation %.2f deg", to_degrees, losses.rotation_rad},
                                     {"critic %.2f deg", to_degrees, losses.angle_gain_rad}};
  const std::vector<Shown> grasp = {{"discriminator %.2f deg", to_degrees, losses.angle_gain_rad},
                                    {"affordance %.2f deg", to_degrees, losses.affordance_rad}};
  const std::vector<Shown> find = {{"mask %.4f nat", 1, losses.mask},
                                   {"place %.4f nat", 1, losses.place}};
  std::string text;
  for (const Shown& shown : family == NetworkFamily::kMotion  ? motion
                            : family == NetworkFamily::kGrasp ? grasp
                                                              : find) {
    if (!shown.value) continue;
    char part[64];
    std::snprintf(part, sizeof part, shown.format, shown.unit * *shown.value);
    text += (text.empty() ? "" : ", ") + std::string(part);
  }
  return text;
}

TrainingOutcome TrainIntoFolder(const TrainingRequest& request) {
  if (request.config.device == "libtorch" || request.config.encoder_norm == EncoderNorm::kBatch)
    KeepFreedMemory();
  const auto group = request.nodes ? ProcessGroupFromEnvironment() : SingleProcessGroup();
  std::optional<FolderLock> lock;
  if (group->rank() == 0) {
    // who writes there now is told first: what there is would be half of the answer
    lock.emplace(request.out, "doorforge train", Writers::kOne);
    CheckFolder(request);
    RemoveStaleFiles(SystemFiles(), request.out);
  }
  if (const std::string slow = SlowLinearAlgebra(); !slow.empty()) request.warn(slow);
  const TrainConfig& config = request.config;
  const StageDataset dataset =
      ReadStageDataset(request.data, request.stage, config.validation_share,
                       {config.colors, config.state != StateKind::kJoints});
  return FolderTraining(request, *group, dataset).Run();
}

std::string OutcomeText(const TrainingOutcome& outcome, const TrainingRequest& request) {
  const auto place = [](const fs::path& path) {
    return fs::absolute(path).lexically_normal().string() + "\n";
  };
  std::string text = "policy:     " + place(request.out) +
                     "curves:     " + place(request.out / kCurvesPage) +
                     "samples:    " + std::to_string(outcome.train_samples) + " for training, " +
                     std::to_string(outcome.validation_samples) + " for validation\n";
  if (const auto& turned = outcome.turned)
    text += "turned:     " + std::to_string(turned->correct) + " of " +
            std::to_string(turned->turned) + " last actions told, " +
            std::to_string(turned->called - turned->correct) + " of " +
            std::to_string(turned->called) + " calls too early (validation)\n";
  if (!outcome.last_epoch) return text;
  const NetworkFamily family = request.config.family;
  text += "training:   " + LossText(outcome.last_epoch->train, family) + "\n";
  if (outcome.validation_samples > 0)
    text += "validation: " + LossText(outcome.last_epoch->validation, family) + "\n";
  return text;
}

}  // namespace doorforge
