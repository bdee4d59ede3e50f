// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "expert_film.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/film_recorder.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/run_episode.h"

namespace doorforge::internal {
namespace {

// Keeps what the camera saw, by the time.
class CloudKeeper final : public Observer {
 public:
  explicit CloudKeeper(CameraObserver& camera) : camera_(camera) {}

  LabelledCloud Observe(const SceneSnapshot& snapshot) override {
    clouds.emplace_back(snapshot.time_s, camera_.Observe(snapshot));
    return clouds.back().second;
  }

  std::vector<std::pair<double, LabelledCloud>> clouds;

 private:
  CameraObserver& camera_;
};

void AddClouds(const std::vector<std::pair<double, LabelledCloud>>& clouds, Film& film) {
  for (const auto& [time_s, cloud] : clouds) {
    for (FilmFrame& frame : film.frames) {
      if (std::abs(frame.time_s - time_s) < 1e-6) frame.cloud = cloud;
    }
  }
}

}  // namespace

Film FilmOfExpert(const DoorAsset& door, const RobotModel& robot, std::uint64_t seed,
                  bool with_cloud) {
  SceneConfig config;
  config.physics.base = robot.base();
  const Scene scene = PlaceRobotBase(robot, SampleScene(door, seed, 0, config), door);
  std::optional<CameraObserver> camera;
  std::optional<CloudKeeper> keeper;
  if (with_cloud) keeper.emplace(camera.emplace(scene, door, robot));
  FilmRecorder recorder(keeper ? &*keeper : nullptr);
  OpeningExpert expert;
  const Episode episode = RunEpisode(scene, door, robot, expert, &recorder);
  Film film = FilmOf(recorder.Film(episode), door, robot);
  if (keeper) AddClouds(keeper->clouds, film);
  return film;
}

}  // namespace doorforge::internal
