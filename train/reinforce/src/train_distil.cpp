// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/train_distil.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_difference.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/policy/hand_sight.h"
#include "doorforge/reinforce/distil_files.h"

#include "training_state.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

HandPolicyRecord TeacherIn(const fs::path& folder) {
  Require(fs::is_directory(folder), ErrorCode::kMissing,
          "--teacher " + folder.string() +
              ": no such folder; `doorforge reinforce` without --teacher trains one");
  return ReadHandPolicy(folder);
}

// What a teacher's training depends on. The camera may be any: who acts on true states never looked
// through it. So may what counts as open: its episodes went on to their budget, and no reward asks.
std::string TaughtIn(SceneConfig scene) {
  const SceneConfig any;
  scene.physics.finish_hinge_rad = any.physics.finish_hinge_rad;
  scene.episode.open_angle_rad = any.episode.open_angle_rad;
  scene.episode.grip_needed = any.episode.grip_needed;
  nlohmann::ordered_json json = ToJson(scene);
  json.erase("camera");
  return JsonText(json);
}

// A teacher knows what to do in its own environment alone. Records that were made by hand may not
// say which it was.
void RequireSameEnvironment(const fs::path& folder, const HandPolicyRecord& teacher,
                            const SceneConfig& scene) {
  const auto config = ParseJson(teacher.provenance.config, folder.string());
  if (!config.is_object() || !config.contains("scene")) return;
  SceneConfig before;
  Assign(config["scene"], before, folder.string() + ": config.scene");
  const std::string recorded = TaughtIn(before);
  const std::string given = TaughtIn(scene);
  Require(recorded == given, ErrorCode::kInvalidArgument,
          "--teacher " + folder.string() +
              ": was trained in another environment; give its --preset and settings of scenes, or "
              "a teacher of this one" +
              ConfigDifference(recorded, given));
}

// What a training belongs to: settings and doors, and who taught.
PpoOrigin DistilOriginOf(const DistilConfig& config, const HandPolicyRecord& teacher,
                         const std::vector<FoundDoor>& doors) {
  nlohmann::ordered_json settings = ToJson(config);
  settings["teacher"] = {{"weights_sha256", teacher.weights_sha256},
                         {"task", ToJson(teacher.task)}};
  return {JsonText(settings), internal::HashOfDoors(doors)};
}

std::string DistilNote(const DaggerState& state) {
  if (state.rounds.empty()) return "";
  const DaggerRound& last = state.rounds.back();
  char text[96];
  std::snprintf(text, sizeof text, "round %zu: opened %.0f %%, error %.3f", state.rounds.size(),
                100 * last.success, last.error);
  return text;
}

/// How much of a training is done, in episodes and steps of the gradient.
class DistilMeter {
 public:
  DistilMeter(const DaggerConfig& config, std::size_t rounds_done)
      : progress_("distil", WorkOf(config, static_cast<std::size_t>(config.rounds)) -
                                WorkOf(config, rounds_done)) {}

  void Advance(const std::string& note) { progress_.Advance(1, note); }

 private:
  static std::size_t WorkOf(const DaggerConfig& config, std::size_t rounds) {
    if (rounds == 0) return 0;
    return rounds * static_cast<std::size_t>(config.episodes) +
           static_cast<std::size_t>(config.cloning_minibatches) +
           (rounds - 1) * static_cast<std::size_t>(config.minibatches);
  }

  Progress progress_;
};

/// A training in its folder.
class DistilFolder {
 public:
  DistilFolder(const DistilRequest& request, const HandPolicyRecord& teacher,
               const std::vector<FoundDoor>& doors)
      : request_(request),
        teacher_(teacher),
        task_(DistilTask(doors, teacher, request.config)),
        origin_(DistilOriginOf(request.config, teacher, doors)),
        parts_(Union(teacher.provenance.trained_on, internal::PartsOfDoors(doors))) {}

  DaggerState Run() {
    const DaggerConfig& config = request_.config.dagger;
    progress_.state = InitialDaggerState(config);
    DaggerSamples samples{.points = task_.points};
    if (request_.resume && fs::exists(request_.out / internal::kTrainingState)) {
      progress_ = ReadDistilState(request_.out, origin_, std::move(progress_.state));
      samples = ReadDistilSamples(request_.out, progress_, task_,
                                  static_cast<std::size_t>(config.buffer));
    } else {
      fs::remove_all(request_.out / "samples");
    }
    CommitFile(request_.out / "config.yaml", JsonText(ToJson(request_.config), 2) + "\n");
    return TrainWithProgress(std::move(samples));
  }

 private:
  DaggerState TrainWithProgress(DaggerSamples samples) {
    const DaggerConfig& config = request_.config.dagger;
    DaggerState state = progress_.state;
    DistilMeter meter(config, state.rounds.size());
    std::string note = DistilNote(state);
    DaggerHooks hooks{.threads = request_.threads};
    hooks.on_progress = [&](std::size_t, std::size_t) { meter.Advance(note); };
    hooks.on_round = [&](const DaggerState& now, const DaggerSamples& fresh) {
      Write(now, fresh);
      note = DistilNote(now);
    };
    hooks.stop = internal::StopAfter(request_.minutes);
    return TrainDagger(task_, config, std::move(state), std::move(samples), hooks);
  }

  // The state last: who goes on from it finds samples, policy and curves of the same round, or
  // makes them.
  void Write(const DaggerState& state, const DaggerSamples& fresh) {
    progress_.state = state;
    progress_.samples_sha256.push_back(
        WriteDistilSamples(request_.out, state.rounds.size() - 1, fresh));
    WriteSightPolicy(request_.out,
                     {state.shape,
                      state.network,
                      teacher_.task,
                      request_.config.look,
                      {kDistilMethod, CodeVersion(), JsonText(ToJson(request_.config)),
                       static_cast<std::uint64_t>(state.rounds.back().decisions), parts_,
                       teacher_.weights_sha256}});
    WriteDistilCurves(request_.out, state, request_.config.dagger, origin_);
    WriteDistilState(request_.out, progress_, origin_);
  }

  const DistilRequest& request_;
  const HandPolicyRecord& teacher_;
  DaggerTask task_;
  PpoOrigin origin_;
  SeenParts parts_;
  DistilProgress progress_;
};

}  // namespace

DistilOutcome DistilIntoFolder(DistilRequest request) {
  if (request.rounds) request.config.dagger.rounds = *request.rounds;
  if (request.seed) request.config.dagger.seed = *request.seed;
  CheckDaggerConfig(request.config.dagger, "config.dagger");
  const HandPolicyRecord teacher = TeacherIn(request.teacher);
  RequireSameEnvironment(request.teacher, teacher, request.config.scene);
  const FolderLock lock(request.out, "doorforge reinforce", Writers::kOne);
  internal::RequireUnusedFolder(request.out, request.resume, request.overwrite);
  RemoveStaleFiles(SystemFiles(), request.out);
  const DoorSet set = FindDoorSet(DoorSelectionOf(request.doors, "train"), request.threads);
  const DaggerState state = DistilFolder(request, teacher, set.doors).Run();
  DistilOutcome outcome{.notes = set.notes,
                        .doors = set.doors.size(),
                        .rounds_done = static_cast<int>(state.rounds.size()),
                        .rounds_total = request.config.dagger.rounds};
  if (!state.rounds.empty()) outcome.last = state.rounds.back();
  return outcome;
}

std::string OutcomeText(const DistilOutcome& outcome, const DistilRequest& request) {
  std::string text = internal::OutcomeHead(outcome.notes, request.out, outcome.doors) +
                     "rounds:     " + std::to_string(outcome.rounds_done) + " of " +
                     std::to_string(outcome.rounds_total) + "\n";
  if (!outcome.finished()) text += "stopped:    --resume goes on\n";
  if (outcome.rounds_done == 0) return text;
  char last[192];
  std::snprintf(last, sizeof last,
                "training:   %.0f decisions labelled; in the last round %.0f %% of %.0f episodes "
                "opened, the teacher acting in %.1f %% of the decisions\n",
                outcome.last.decisions, 100 * outcome.last.success, outcome.last.episodes,
                100 * outcome.last.teacher);
  return text + last;
}

}  // namespace doorforge
