// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/stage_episode.h"

#include <memory>
#include <optional>

#include "doorforge/registry/run_policy_set.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/film_recorder.h"
#include "doorforge/rollout/grasp_from_policy.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/schemas/motion_way.h"

#include "episode_records.h"
#include "recording_camera.h"

namespace doorforge {
namespace {

Rng StreamOf(const StageConfig& config, const PlannedEpisode& planned, const std::string& name) {
  return {config.seed, "datagen/" + name + "/" + std::to_string(planned.number)};
}

bool SamplesGrasp(const StageConfig& config, const PlannedEpisode& planned) {
  return config.stage == Stage::kGrasp ||
         StreamOf(config, planned, "sampled_grasps").Uniform() < config.sampled_grasps;
}

int LearnerDecisions(const StageConfig& config, const PlannedEpisode& planned) {
  return 1 + static_cast<int>(StreamOf(config, planned, "learner_decisions")
                                  .Index(static_cast<std::uint32_t>(config.learner_decisions)));
}

struct EpisodeToRun {
  const PlannedEpisode& planned;
  const IdentifiedDoor& door;
  const RobotModel& robot;
  const StageConfig& config;
};

// What those who act in the recorded stage are shown besides what the camera sees now.
struct ShownBesides {
  bool remembers;
  const RememberedViewConfig& remembered;
  bool colors;
};

void PrepareToAct(RecordingCamera& camera, const EpisodePlace& place, const ShownBesides& besides) {
  std::optional<RememberedView> before;
  if (besides.remembers)
    before.emplace(place.scene, place.door, place.robot, place.cloud, besides.remembered);
  if (besides.colors) {
    camera.ColorWith(PolicyColors(place)(place.scene, place.cloud.robot));
    if (before) before->ColorWith(PolicyColors(place));
  }
  if (before) camera.Remember(*std::move(before));
}

// `film`, where there is one, looks on.
CollectedEpisode RunRecorded(const EpisodeToRun& run, StagePolicies& policies, FilmRecorder* film) {
  const auto& [planned, identified, robot, config] = run;
  const DoorAsset& door = *identified;
  const Scene scene = PlaceRobotBase(
      robot, SampleScene(identified, config.seed, planned.number, config.scene), door);
  const auto set = policies.Take();
  const bool at_grasp = config.stage == Stage::kGrasp;
  const bool samples_grasp = SamplesGrasp(config, planned);
  const Scene recorded_scene = at_grasp ? SceneOf(config.grasp_camera, scene) : scene;
  const double crop_radius_m = at_grasp ? config.grasp_camera.crop_radius_m : 0;
  // the grasp is chosen before the robot stands between camera and handle
  std::optional<RecordingCamera> before;
  if (samples_grasp)
    before.emplace(recorded_scene, door, robot, config.cloud, /*sees_robot=*/false);
  std::optional<RecordingCamera> later;
  if (!at_grasp) later.emplace(scene, door, robot, config.cloud, /*sees_robot=*/true);
  const EpisodePlace place{scene, door, robot, config.cloud};
  const bool remembers = config.stage == Stage::kHandle && config.remembered.IsOn();
  if (later) PrepareToAct(*later, place, {remembers, config.remembered, UsesColors(*set)});
  RecordingCamera& camera = at_grasp ? *before : *later;
  if (before && set->grasp && set->grasp->UsesColors())
    before->ColorWith(PolicyColors(place)(recorded_scene, /*sees_robot=*/false));
  std::unique_ptr<CameraObserver> policies_camera;
  if (at_grasp) policies_camera = CameraOf(place, policies.remembered(), UsesColors(*set));
  const CloudExtent extent{config.cloud.point_count, crop_radius_m};
  const auto look = [&](const SceneSnapshot& snapshot) { return before->ObserveAll(snapshot); };
  EpisodePolicies roles{.recorded = config.stage, .open = set->open.get(), .tries = config.tries};
  if (config.stage != Stage::kOpen) roles.handle = set->handle.get();
  std::optional<GraspFromPolicy> grasp;
  if (samples_grasp) {
    roles.grasp = &grasp.emplace(*set->grasp, scene, door, robot, look);
    grasp->RecordWith(extent);
  }
  ObjectPool<std::unique_ptr<Policy>>::Lease driver;
  if (policies.HasDriver()) {
    driver = policies.TakeDriver();
    roles.learner = driver->get();
    roles.learner_decisions = LearnerDecisions(config, planned);
  }

  BeginEpisode(*set, place);
  CollectedEpisode collected;
  Observer* observer = &camera;
  if (policies_camera) observer = policies_camera.get();
  if (film != nullptr) {
    film->LookThrough(observer);
    observer = film;
  }
  collected.episode = RunStages(scene, door, robot, roles, observer);
  const Episode& episode = collected.episode;
  const std::size_t decisions = episode.decisions.size();
  collected.meta = EpisodeMetaToJson(episode);
  collected.meta["stage"] = NameOf(config.stage);
  collected.meta["door"] = DoorRecord(door);
  const MotionWay way = WayOf(door, config.stage);
  if (way != MotionWay::kUsual) collected.meta["way"] = NameOf(way);
  if (door.hinge_side != HingeSide::kLeft) collected.meta["side"] = NameOf(door.hinge_side);
  collected.meta["poses"] = PosesRecord(episode.scene);
  collected.meta["camera"] = CameraRecord(recorded_scene.camera);
  collected.meta["visible_points"] = camera.Visible(decisions);
  collected.meta["hidden"] = camera.OcclusionRecord(decisions);
  collected.meta["policies"] = policies.Record(samples_grasp);
  if (at_grasp) {
    collected.meta["robot_seen"] = false;
    collected.meta["cloud_within_m"] = crop_radius_m;
  }
  if (remembers) {
    collected.meta["remembered_finer"] = config.remembered.resolution_scale;
    collected.meta["cloud_within_m"] = config.remembered.crop_radius_m;
  }
  collected.keep_failed = at_grasp;
  const bool is_kept = episode.outcome == EpisodeOutcome::kOpened || collected.keep_failed;
  if (config.preview && is_kept) collected.preview_png = camera.PreviewPng(decisions);
  Remembering remembering{config.cloud, {}};
  if (remembers) remembering.view = config.remembered;
  AddPictures(
      {recorded_scene, door, robot, !at_grasp && config.cloud.robot, camera.as_calibrated()},
      config.pictures, camera, remembering, collected);
  return collected;
}

}  // namespace

CollectedEpisode RunStageEpisode(const PlannedEpisode& planned, const IdentifiedDoor& door,
                                 const RobotModel& robot, const StageConfig& config,
                                 StagePolicies& policies) {
  return RunRecorded({planned, door, robot, config}, policies, nullptr);
}

EpisodeFilm FilmStageEpisode(const PlannedEpisode& planned, const IdentifiedDoor& door,
                             const RobotModel& robot, const StageConfig& config,
                             StagePolicies& policies) {
  FilmRecorder film;
  return film.Film(RunRecorded({planned, door, robot, config}, policies, &film).episode);
}

}  // namespace doorforge
