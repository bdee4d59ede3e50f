// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/evaluate/run_trials.h"

#include <mutex>
#include <string>
#include <utility>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/rollout/standing_place.h"

namespace doorforge {
namespace {

// Lends sets of policies: as many as are ever in use at once, each to one episode at a time.
class PlayerPool {
 public:
  explicit PlayerPool(const Contender& contender) : contender_(contender) {}

  Players Take() {
    const std::scoped_lock lock(mutex_);
    if (idle_.empty()) return contender_.make_players();
    Players players = std::move(idle_.back());
    idle_.pop_back();
    return players;
  }

  void Return(Players players) {
    const std::scoped_lock lock(mutex_);
    idle_.push_back(std::move(players));
  }

 private:
  const Contender& contender_;
  std::mutex mutex_;
  std::vector<Players> idle_;
};

void RequireAtLeastOne(int value, const std::string& name) {
  Require(value >= 1, ErrorCode::kInvalidConfig,
          "config." + name + ": " + std::to_string(value) + ", expected 1 or more");
}

}  // namespace

std::vector<Trial> PlanTrials(std::span<const DoorAsset> doors, const EvaluationConfig& config) {
  RequireAtLeastOne(config.seeds, "seeds");
  RequireAtLeastOne(config.episodes_per_door, "episodes_per_door");
  Require(config.scene.robot.empty(), ErrorCode::kInvalidConfig,
          "config.scene.robot: eval knows the built-in robot, on any base; let the expert try \"" +
              config.scene.robot + "\" with `doorforge simulate --robot`");
  const RobotModel robot = LoadRobot({}, RobotBaseNamed(config.scene.physics.base));
  std::vector<Trial> trials;
  for (std::size_t door = 0; door < doors.size(); ++door) {
    for (int seed = 0; seed < config.seeds; ++seed) {
      for (int episode = 0; episode < config.episodes_per_door; ++episode) {
        const Scene scene =
            SampleScene(doors[door], config.first_seed + static_cast<std::uint64_t>(seed),
                        static_cast<std::uint64_t>(episode), config.scene);
        trials.push_back({door, SceneFor(robot, scene, doors[door])});
      }
    }
  }
  return trials;
}

Episode PlayTrial(const Scene& scene, const DoorAsset& door, const RobotModel& robot,
                  const Players& players, Observer* observer) {
  std::unique_ptr<GraspChooser> grasp;
  if (players.make_grasp) grasp = players.make_grasp(scene, door, robot);
  return RunStages(scene, door, robot,
                   {.grasp = grasp.get(),
                    .handle = players.handle.get(),
                    .predicted_turned = players.predicted_turned,
                    .open = players.open.get()},
                   observer);
}

std::vector<EvaluatedEpisode> RunTrials(std::span<const DoorAsset> doors,
                                        std::span<const Trial> trials, const Contender& contender,
                                        const RunHooks& hooks) {
  if (trials.empty()) return {};
  const RobotModel robot = LoadRobot({}, RobotBaseNamed(trials[0].scene.physics.base));
  PlayerPool pool(contender);
  std::vector<EvaluatedEpisode> rows(trials.size());
  ParallelFor(trials.size(), hooks.threads, [&](std::size_t i) {
    Require(StopRequested() == 0, ErrorCode::kIncomplete, "evaluation interrupted");
    const DoorAsset& door = doors[trials[i].door];
    const Scene& scene = trials[i].scene;
    std::unique_ptr<Observer> observer;
    if (contender.make_observer) observer = contender.make_observer(scene, door);
    Players players = pool.Take();
    rows[i] = RowOf(PlayTrial(scene, door, robot, players, observer.get()), door.category);
    pool.Return(std::move(players));
    if (hooks.done) hooks.done(rows[i]);
  });
  return rows;
}

}  // namespace doorforge
