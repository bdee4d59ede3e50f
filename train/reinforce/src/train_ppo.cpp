// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/train_ppo.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/policy/frozen_sight.h"
#include "doorforge/policy/hand_network.h"
#include "doorforge/reinforce/ppo_files.h"

#include "training_state.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

std::string PpoNote(const PpoUpdate& update) {
  char text[96];
  std::snprintf(text, sizeof text, "decisions; opened %.0f %%, reward %.1f, kl %.3f",
                100 * update.success, update.reward, update.kl);
  return text;
}

// Whose features a hand acts on; nothing: on true states.
std::optional<SightPolicyRecord> FeaturesIn(const fs::path& folder) {
  if (folder.empty()) return std::nullopt;
  Require(fs::is_directory(folder), ErrorCode::kMissing,
          "--features " + folder.string() +
              ": no such folder; `doorforge reinforce --teacher` trains one");
  return ReadSightPolicy(folder);
}

std::shared_ptr<const FrozenSight> FrozenOf(const std::optional<SightPolicyRecord>& features) {
  if (!features) return nullptr;
  return std::make_shared<FrozenSight>(features->shape, features->parameters, features->look);
}

// What a training belongs to: settings and doors, and whose features.
PpoOrigin PpoOriginOf(const HandTrainingConfig& config,
                      const std::optional<SightPolicyRecord>& features,
                      const std::vector<FoundDoor>& doors) {
  nlohmann::ordered_json settings = ToJson(config);
  if (features) settings["features"] = {{"weights_sha256", features->weights_sha256}};
  return {JsonText(settings), internal::HashOfDoors(doors)};
}

/// A training in its folder.
class PpoFolder {
 public:
  PpoFolder(const PpoTrainingRequest& request, std::optional<SightPolicyRecord> features,
            const std::vector<FoundDoor>& doors)
      : request_(request),
        features_(std::move(features)),
        task_(DoorTask(doors, request.config, FrozenOf(features_))),
        origin_(PpoOriginOf(request.config, features_, doors)),
        parts_(internal::PartsOfDoors(doors)) {
    if (features_) parts_ = Union(parts_, features_->provenance.trained_on);
  }

  PpoState Run() {
    const PpoConfig& config = request_.config.ppo;
    PpoState state = InitialPpoState(task_, config);
    if (request_.resume && HasPpoState(request_.out))
      state = ReadPpoState(request_.out, origin_, std::move(state));
    CommitFile(request_.out / "config.yaml", JsonText(ToJson(request_.config), 2) + "\n");
    return TrainWithProgress(std::move(state));
  }

 private:
  PpoState TrainWithProgress(PpoState state) {
    const PpoConfig& config = request_.config.ppo;
    const std::size_t each =
        static_cast<std::size_t>(config.steppers) * static_cast<std::size_t>(config.steps);
    const std::size_t left = static_cast<std::size_t>(PpoUpdatesOf(config)) - state.updates.size();
    Progress progress("train ppo", left * each);
    PpoHooks hooks{.threads = request_.threads};
    hooks.on_update = [&](const PpoState& now) {
      Write(now);
      progress.Advance(each, PpoNote(now.updates.back()));
    };
    hooks.stop = internal::StopAfter(request_.minutes);
    return TrainPpo(task_, config, std::move(state), hooks);
  }

  // The state last: who goes on from it finds curves and policy of the same update, or makes them.
  void Write(const PpoState& state) const {
    WriteActor(state);
    WritePpoCurves(request_.out, state);
    CommitFile(request_.out / "training.html", PpoPage(state, request_.config.ppo, origin_));
    WritePpoState(request_.out, state, origin_);
  }

  void WriteActor(const PpoState& state) const {
    const PpoNetworks& networks = state.networks;
    const HandTaskConfig& task = request_.config.task;
    HandProvenance provenance{kPpoMethod, CodeVersion(), origin_.config,
                              static_cast<std::uint64_t>(state.updates.back().decisions), parts_};
    if (!features_)
      return WriteHandPolicy(request_.out,
                             {networks.actor_shape, networks.actor, task, std::move(provenance)});
    provenance.teacher_sha256 = features_->weights_sha256;
    WriteFrozenPolicy(request_.out,
                      {features_->shape, features_->parameters, features_->look,
                       networks.actor_shape, networks.actor, task, std::move(provenance)});
  }

  const PpoTrainingRequest& request_;
  std::optional<SightPolicyRecord> features_;
  PpoTask task_;
  PpoOrigin origin_;
  SeenParts parts_;
};

}  // namespace

PpoTrainingOutcome TrainPpoIntoFolder(PpoTrainingRequest request) {
  if (request.decisions) request.config.ppo.decisions = *request.decisions;
  if (request.seed) request.config.ppo.seed = *request.seed;
  CheckPpoConfig(request.config.ppo, "config.ppo");
  std::optional<SightPolicyRecord> features = FeaturesIn(request.features);
  const FolderLock lock(request.out, "doorforge reinforce", Writers::kOne);
  internal::RequireUnusedFolder(request.out, request.resume, request.overwrite);
  RemoveStaleFiles(SystemFiles(), request.out);
  const DoorSet set = FindDoorSet(DoorSelectionOf(request.doors, "train"), request.threads);
  const PpoState state = PpoFolder(request, std::move(features), set.doors).Run();
  PpoTrainingOutcome outcome{.notes = set.notes,
                             .doors = set.doors.size(),
                             .updates_done = state.updates.size(),
                             .updates_total = PpoUpdatesOf(request.config.ppo)};
  if (!state.updates.empty()) outcome.last = state.updates.back();
  return outcome;
}

std::string OutcomeText(const PpoTrainingOutcome& outcome, const PpoTrainingRequest& request) {
  std::string text = internal::OutcomeHead(outcome.notes, request.out, outcome.doors) +
                     "updates:    " + std::to_string(outcome.updates_done) + " of " +
                     std::to_string(outcome.updates_total) + "\n";
  if (!outcome.finished()) text += "stopped:    --resume goes on\n";
  if (outcome.updates_done == 0) return text;
  char last[128];
  std::snprintf(last, sizeof last,
                "training:   %.0f decisions; in the last update %.0f %% of %.0f episodes opened, "
                "with noise\n",
                outcome.last.decisions, 100 * outcome.last.success, outcome.last.episodes);
  return text + last;
}

}  // namespace doorforge
