// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/reinforce/train_trajectories.h"

#include <cstdio>
#include <utility>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/reinforce/trajectory_files.h"

#include "training_state.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

std::string TrajectoryNote(const TrajectoryState& state) {
  if (state.rounds.empty()) return "";
  const TrajectoryRound& last = state.rounds.back();
  char text[96];
  std::snprintf(text, sizeof text, "round %zu: opened %.0f %%, critic %.3f", state.rounds.size(),
                100 * last.success, last.critic);
  return text;
}

// Episodes, steps of the gradient and rated contacts of the rounds up to this one.
std::size_t WorkUpTo(const TrajectoryLearning& config, std::size_t rounds) {
  const auto episodes = static_cast<std::size_t>(config.episodes);
  return rounds * (episodes + 3 * static_cast<std::size_t>(config.minibatches)) +
         rounds * (rounds + 1) / 2 * episodes;
}

/// A training in its folder.
class TrajectoryFolder {
 public:
  TrajectoryFolder(const TrajectoryTrainingRequest& request, const std::vector<FoundDoor>& doors)
      : request_(request),
        task_(TrajectoryLessons(doors, request.config)),
        origin_{JsonText(ToJson(request.config)), internal::HashOfDoors(doors)},
        parts_(internal::PartsOfDoors(doors)) {}

  TrajectoryState Run() {
    const TrajectoryTrainingConfig& config = request_.config;
    progress_.state = InitialTrajectoryState(config.network, config.learning.seed);
    TrajectorySamples samples{.points = task_.points,
                              .numbers = TrajectoryNumbers(config.network.waypoints)};
    if (request_.resume && fs::exists(request_.out / internal::kTrainingState)) {
      progress_ = ReadTrajectoryState(request_.out, origin_, std::move(progress_.state));
      samples = ReadTrajectorySamples(request_.out, progress_, std::move(samples));
    } else {
      fs::remove_all(request_.out / "samples");
    }
    CommitFile(request_.out / "config.yaml", JsonText(ToJson(config), 2) + "\n");
    return TrainWithProgress(std::move(samples));
  }

 private:
  TrajectoryState TrainWithProgress(TrajectorySamples samples) {
    const TrajectoryLearning& config = request_.config.learning;
    TrajectoryState state = progress_.state;
    Progress meter("trajectories", WorkUpTo(config, static_cast<std::size_t>(config.rounds)) -
                                       WorkUpTo(config, state.rounds.size()));
    std::string note = TrajectoryNote(state);
    TrajectoryHooks hooks{.threads = request_.threads};
    hooks.on_progress = [&] { meter.Advance(1, note); };
    hooks.on_round = [&](const TrajectoryState& now, const TrajectorySamples& fresh) {
      Write(now, fresh);
      note = TrajectoryNote(now);
    };
    hooks.stop = internal::StopAfter(request_.minutes);
    return TrainTrajectories(task_, config, std::move(state), std::move(samples), hooks);
  }

  // The state last: who goes on from it finds samples, policy and curves of the same round, or
  // makes them.
  void Write(const TrajectoryState& state, const TrajectorySamples& fresh) {
    const TrajectoryTrainingConfig& config = request_.config;
    progress_.state = state;
    progress_.samples_sha256.push_back(
        WriteTrajectorySamples(request_.out, state.rounds.size() - 1, fresh));
    WriteTrajectoryPolicy(request_.out,
                          {state.Networks(),
                           config.look,
                           config.choice,
                           {kTrajectoryMethod, CodeVersion(), JsonText(ToJson(config)),
                            static_cast<std::uint64_t>(state.rounds.back().episodes), parts_}});
    WriteTrajectoryCurves(request_.out, state, config.learning, origin_);
    WriteTrajectoryState(request_.out, progress_, origin_);
  }

  const TrajectoryTrainingRequest& request_;
  TrajectoryTask task_;
  PpoOrigin origin_;
  SeenParts parts_;
  TrajectoryProgress progress_;
};

}  // namespace

TrajectoryTrainingOutcome TrainTrajectoriesIntoFolder(TrajectoryTrainingRequest request) {
  TrajectoryLearning& learning = request.config.learning;
  if (request.rounds) learning.rounds = *request.rounds;
  if (request.seed) learning.seed = *request.seed;
  CheckTrajectoryTraining(request.config);
  const FolderLock lock(request.out, "doorforge reinforce", Writers::kOne);
  internal::RequireUnusedFolder(request.out, request.resume, request.overwrite);
  RemoveStaleFiles(SystemFiles(), request.out);
  const DoorSet set = FindDoorSet(DoorSelectionOf(request.doors, "train"), request.threads);
  const TrajectoryState state = TrajectoryFolder(request, set.doors).Run();
  TrajectoryTrainingOutcome outcome{.notes = set.notes,
                                    .doors = set.doors.size(),
                                    .rounds_done = static_cast<int>(state.rounds.size()),
                                    .rounds_total = learning.rounds};
  if (!state.rounds.empty()) outcome.last = state.rounds.back();
  return outcome;
}

std::string OutcomeText(const TrajectoryTrainingOutcome& outcome,
                        const TrajectoryTrainingRequest& request) {
  std::string text = internal::OutcomeHead(outcome.notes, request.out, outcome.doors) +
                     "rounds:     " + std::to_string(outcome.rounds_done) + " of " +
                     std::to_string(outcome.rounds_total) + "\n";
  if (!outcome.finished()) text += "stopped:    --resume goes on\n";
  if (outcome.rounds_done == 0) return text;
  char last[192];
  std::snprintf(last, sizeof last,
                "training:   %.0f episodes; of those of the last round %.0f %% opened, with few "
                "proposals each\n",
                outcome.last.episodes, 100 * outcome.last.success);
  return text + last;
}

}  // namespace doorforge
