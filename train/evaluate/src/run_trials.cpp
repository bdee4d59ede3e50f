// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/evaluate/run_trials.h"

#include <string>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/object_pool.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/registry/run_policy_set.h"
#include "doorforge/rollout/base_placement.h"

namespace doorforge {
namespace {

constexpr int kMostRepetitions = 100000;       // of a door
constexpr std::size_t kMostTrials = 10000000;  // a row of some hundred bytes each

std::size_t Repetitions(int value, const std::string& name) {
  Require(value >= 1 && value <= kMostRepetitions, ErrorCode::kInvalidConfig,
          "config." + name + ": " + std::to_string(value) + ", expected 1 to " +
              std::to_string(kMostRepetitions));
  return static_cast<std::size_t>(value);
}

}  // namespace

TrialPlan::TrialPlan(DoorGiver give_door, std::size_t door_count, const EvaluationConfig& config)
    : give_door_(std::move(give_door)),
      door_count_(door_count),
      seeds_(Repetitions(config.seeds, "seeds")),
      episodes_per_door_(Repetitions(config.episodes_per_door, "episodes_per_door")),
      first_seed_(config.first_seed),
      scene_(config.scene),
      cloud_(config.cloud),
      robot_(LoadRobot({}, config.scene.physics.base)) {
  Require(config.scene.robot.empty(), ErrorCode::kInvalidConfig,
          "config.scene.robot: eval knows the built-in robot, on any base; let the expert try \"" +
              config.scene.robot + "\" with `doorforge simulate --robot`");
  Require(size() <= kMostTrials, ErrorCode::kInvalidConfig,
          "config.seeds, config.episodes_per_door: " + std::to_string(size()) +
              " episodes, expected at most " + std::to_string(kMostTrials));
}

std::size_t TrialPlan::size() const { return door_count_ * seeds_ * episodes_per_door_; }

std::size_t TrialPlan::DoorOf(std::size_t trial) const {
  return trial / (seeds_ * episodes_per_door_);
}

TrialPlan::Taken TrialPlan::Take(std::size_t door) const {
  try {
    return {give_door_(door), ""};
  } catch (const Error& error) {
    // All were there when the trials were planned. A door that has changed since is another door,
    // and what is wrong with the call is not the door's: these end the run.
    if (error.code() != ErrorCode::kMissing && error.code() != ErrorCode::kIo) throw;
    return {{}, error.what()};
  }
}

std::shared_ptr<const DoorAsset> TrialPlan::Door(std::size_t door) const {
  return Take(door).door.door;
}

TrialPlan::Staged TrialPlan::At(std::size_t trial) const {
  const std::uint64_t seed = first_seed_ + trial / episodes_per_door_ % seeds_;
  const std::uint64_t episode = trial % episodes_per_door_;
  Taken taken = Take(DoorOf(trial));
  if (taken.door.door == nullptr) {
    Scene nowhere;
    nowhere.seed = seed;
    nowhere.episode = episode;
    return {nullptr, std::move(nowhere), std::move(taken.gone)};
  }
  Scene scene = SampleScene(taken.door, seed, episode, scene_);
  scene = PlaceRobotBase(robot_, scene, *taken.door);
  return {std::move(taken.door.door), std::move(scene)};
}

std::vector<EvaluatedEpisode> RunTrials(const TrialPlan& trials, const TrialPolicies& policies,
                                        const RunHooks& hooks) {
  ObjectPool<PolicySet> pool(policies.make);
  std::vector<EvaluatedEpisode> rows(trials.size());
  ParallelFor(trials.size(), hooks.threads, [&](std::size_t i) {
    Require(StopRequested() == 0, ErrorCode::kIncomplete, "evaluation interrupted");
    const auto [held, scene, gone] = trials.At(i);
    if (held != nullptr) {
      const DoorAsset& door = *held;
      const auto set = pool.Take();
      std::unique_ptr<Observer> observer;
      if (policies.make_observer) observer = policies.make_observer(scene, door, *set);
      rows[i] = RowOf(
          RunPolicySet({scene, door, trials.robot(), trials.cloud()}, *set, observer.get()), door);
    } else {
      Require(!hooks.doors.empty(), ErrorCode::kMissing, gone);
      rows[i] = RowOfGoneDoor(hooks.doors[trials.DoorOf(i)], scene, gone);
    }
    if (hooks.done) hooks.done(rows[i]);
  });
  return rows;
}

}  // namespace doorforge
