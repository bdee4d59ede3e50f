// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/evaluate/take_pictures.h"

#include <algorithm>
#include <array>
#include <optional>

#include "doorforge/core/error.h"
#include "doorforge/core/object_pool.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/registry/run_policy_set.h"
#include "doorforge/report/html_numbers.h"
#include "doorforge/report/outcome_text.h"
#include "doorforge/report/success_statistics.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/film_recorder.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/sensor/affordance_picture.h"
#include "doorforge/sensor/depth_camera.h"
#include "doorforge/sensor/picture.h"
#include "doorforge/sensor/scene_picture.h"

#include "episode_film.h"

namespace doorforge {
namespace {

// the door alone, closed; link indices as in VisibleMeshesOf()
std::vector<VisibleMesh> MeshesOf(const DoorAsset& door) {
  std::vector<VisibleMesh> meshes;
  for (std::size_t link = 0; link < door.links.size(); ++link) {
    for (const DoorGeometry& geometry : door.links[link].geometry) {
      meshes.push_back(
          {geometry.mesh, static_cast<int>(link), geometry.label, geometry.color_rgba.head<3>()});
    }
  }
  return meshes;
}

std::string DoorPng(const DoorAsset& door) {
  SceneGeometry scene(MeshesOf(door));
  const auto poses = DoorFromLinks(door, 0, 0);
  scene.MoveLinks(poses);
  ViewConfig view;
  view.width = 320;
  view.height = 320;
  return EncodePng(RenderPicture(scene, FramingCamera(scene, view)));
}

// the first trial of each outcome
std::vector<std::size_t> TrialsToFilm(std::span<const EvaluatedEpisode> rows) {
  std::array<std::optional<std::size_t>, kEpisodeOutcomeCount> first;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!CanBeShown(CauseOf(rows[i]))) continue;
    auto& place = first.at(static_cast<std::size_t>(rows[i].outcome));
    if (!place) place = i;
  }
  std::vector<std::size_t> trials;
  for (const auto& place : first) {
    if (place) trials.push_back(*place);
  }
  return trials;
}

/// Without frames where a policy that need not act alike twice did not, or the door is gone.
struct FilmedTrial {
  ReportFilm film;
  std::optional<SceneSnapshot> first_decision;
};

FilmedTrial FilmTrial(const FinishedTrials& finished, std::size_t index, const PolicySet& set,
                      const TrialPolicies& policies) {
  const auto [held, scene, gone] = finished.trials.At(index);
  if (held == nullptr) return {};
  const DoorAsset& door = *held;
  const RobotModel robot = LoadRobot({}, scene.physics.base);
  internal::EpisodeFilm film(policies.make_observer ? policies.make_observer(scene, door, set)
                                                    : nullptr);
  const Episode episode = RunPolicySet({scene, door, robot, finished.trials.cloud()}, set, &film);
  const bool repeated = episode.state_sha256 == finished.rows[index].state_sha256;
  if (!repeated && IsFallible(set)) return {};
  Require(repeated, ErrorCode::kInvalidArgument,
          door.id + ": the episode for the film strip ended in another state than the first run");
  FilmedTrial filmed;
  filmed.film.frames = internal::RenderFrames(film.Frames(), scene, door, robot);
  filmed.film.caption =
      door.id + ", seed " + std::to_string(scene.seed) + ": " + finished.rows[index].detail;
  if (film.HasDecision()) filmed.first_decision = film.FirstDecision();
  return filmed;
}

// Nothing where a policy that need not act alike twice did not, or the door is gone.
std::optional<EpisodeFilm> FilmOfTrial(const FinishedTrials& finished, std::size_t index,
                                       const PolicySet& set, const TrialPolicies& policies) {
  const auto [held, scene, gone] = finished.trials.At(index);
  if (held == nullptr) return {};
  const DoorAsset& door = *held;
  const RobotModel robot = LoadRobot({}, scene.physics.base);
  std::unique_ptr<Observer> camera;
  if (policies.make_observer) camera = policies.make_observer(scene, door, set);
  FilmRecorder recorder(camera.get());
  const Episode episode =
      RunPolicySet({scene, door, robot, finished.trials.cloud()}, set, &recorder);
  const bool repeated = episode.state_sha256 == finished.rows[index].state_sha256;
  if (!repeated && IsFallible(set)) return std::nullopt;
  Require(repeated, ErrorCode::kInvalidArgument,
          door.id + ": the episode for the film ended in another state than the first run");
  return recorder.Film(episode);
}

void AddSight(const FinishedTrials& finished, std::size_t index, const SceneSnapshot& snapshot,
              ReportPictures& pictures) {
  const auto [held, scene, gone] = finished.trials.At(index);
  if (held == nullptr) return;
  const DoorAsset& door = *held;
  const RobotModel robot = LoadRobot({}, scene.physics.base);
  DepthCamera camera(VisibleMeshesOf(door, robot));
  const DepthImage depth = camera.Render(scene.camera, LinkPosesOf(snapshot));
  CameraModel large = scene.camera;  // the same view with pixels enough for people
  large.width *= 2;
  large.height *= 2;
  pictures.scene = {EncodePng(RenderPicture(camera.scene(), large)),
                    "The scene from the policy's camera when it takes over: " + door.id +
                        ", seed " + std::to_string(scene.seed) + "."};
  pictures.depth = {EncodePng(DepthPreview(depth)),
                    "The depth image, " + std::to_string(depth.width) + " × " +
                        std::to_string(depth.height) +
                        ": near is yellow, far violet; the robot hides part of the door."};
  const SampledCloud sampled =
      ObserveCloud(depth, scene.camera, snapshot.robot.world_from_tcp.translation());
  CameraModel close = large;  // from the same place, nearer to the gripper
  close.target_m = snapshot.robot.world_from_tcp.translation();
  close.horizontal_fov_rad = 0.9;
  pictures.cloud = {EncodePng(CloudPicture(sampled.cloud, close)),
                    "What the policy gets: " + std::to_string(sampled.cloud.label.size()) +
                        " points by farthest point sampling, here enlarged. Its labels, which the "
                        "policy is not given: leaf blue, handle orange, frame grey, robot green."};
}

// Remembers the beginning of an episode and the grasp that was chosen then; there the episode ends.
class Onlooker : public SnapshotGraspPolicy {
 public:
  explicit Onlooker(GraspFromPolicy& grasp) : grasp_(grasp) {}

  std::optional<GraspCommand> Choose(const SceneSnapshot& snapshot) override {
    start = snapshot;
    action = grasp_.ActionAt(snapshot);
    return std::nullopt;
  }

  SceneSnapshot start;
  std::optional<GraspAction> action;

 private:
  GraspFromPolicy& grasp_;
};

// For each category the first trial that opened and those that did not, until one is pictured.
struct GraspToShow {
  Category category;
  bool opened;
  std::vector<std::size_t> trials;
};

std::vector<GraspToShow> GraspsToShow(std::span<const EvaluatedEpisode> rows) {
  std::vector<GraspToShow> shown;
  for (const Category category : CategoriesOf(rows)) {
    for (const bool opened : {true, false}) {
      GraspToShow& show = shown.emplace_back(GraspToShow{category, opened, {}});
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const bool fits = (rows[i].outcome == EpisodeOutcome::kOpened) == opened;
        if (rows[i].category == category && fits) show.trials.push_back(i);
      }
    }
  }
  return shown;
}

std::string GraspCaption(const EvaluatedEpisode& row, const GraspExplanation& choice) {
  const auto [low, high] =
      std::minmax_element(choice.affordance_rad.begin(), choice.affordance_rad.end());
  return row.door_id + ", seed " + std::to_string(row.seed) + ": affordance " +
         internal::Degrees(static_cast<double>(*low)) + " to " +
         internal::Degrees(static_cast<double>(*high)) + " over " +
         std::to_string(choice.affordance_rad.size()) +
         " points of the handle; the chosen grasp is expected to open the door by " +
         internal::Degrees(choice.expected_opening_rad) + ", it reached " +
         internal::Degrees(row.peak_hinge_rad) + ". " + internal::TextOf(CauseOf(row)).title +
         ": " + row.detail;
}

// The heat map of a trial's grasp; nothing where none was in view, or the door is gone.
std::optional<ReportPicture> GraspPicture(const FinishedTrials& finished, std::size_t index,
                                          const PolicySet& set) {
  const auto [held, scene, gone] = finished.trials.At(index);
  if (held == nullptr) return {};
  const DoorAsset& door = *held;
  const RobotModel robot = LoadRobot({}, scene.physics.base);
  const auto grasp = GraspOf(set, {scene, door, robot, finished.trials.cloud()});
  Onlooker onlooker(*grasp);
  RunStages(scene, door, robot, {.grasp = &onlooker, .open = set.open.get()}, nullptr);
  if (!onlooker.action) return std::nullopt;
  const GraspAction& action = *onlooker.action;
  const GraspExplanation& explanation = *action.explanation;
  AffordanceMap map{explanation.point_xyz, explanation.affordance_rad, action.contact_m};
  map.world_from_tcp.linear() = action.world_from_hand_rotation * robot.hand_from_tcp().linear();
  map.world_from_tcp.translation() =
      action.contact_m + kGraspInsertion * action.world_from_hand_rotation.col(2);
  CameraModel view = scene.camera;
  view.width = 480;
  view.height = 400;
  view = CameraOn(map, view);
  DepthCamera camera(MeshesOf(door));
  return ReportPicture{EncodePng(AffordancePicture(camera, onlooker.start.door, view, map)),
                       GraspCaption(finished.rows[index], explanation)};
}

void TakeDoorPictures(const FinishedTrials& finished, int threads, ReportPictures& pictures) {
  const std::size_t all = finished.trials.door_count();
  const std::size_t count = std::min(all, kMostDoorPictures);
  std::vector<std::pair<std::string, std::string>> shown(count);  // id and picture
  ParallelFor(count, threads, [&](std::size_t i) {
    const auto door = finished.trials.Door(i * all / count);
    if (door != nullptr) shown[i] = {door->id, DoorPng(*door)};
  });
  for (auto& [id, png] : shown) {
    if (!id.empty()) pictures.doors[id] = std::move(png);
  }
}

}  // namespace

std::vector<EpisodeFilm> TakeFilms(const FinishedTrials& finished, const TrialPolicies& policies,
                                   int threads) {
  std::vector<std::size_t> failed;
  for (std::size_t i = 0; i < finished.rows.size(); ++i) {
    const std::string_view cause = CauseOf(finished.rows[i]);
    if (cause != NameOf(EpisodeOutcome::kOpened) && cause != kDoorGone) failed.push_back(i);
  }
  ObjectPool<PolicySet> pool(policies.make);
  std::vector<std::optional<EpisodeFilm>> taken(failed.size());
  Progress progress("films", failed.size());
  ParallelFor(failed.size(), threads, [&](std::size_t i) {
    Require(StopRequested() == 0, ErrorCode::kIncomplete, "evaluation interrupted");
    const auto set = pool.Take();
    taken[i] = FilmOfTrial(finished, failed[i], *set, policies);
    progress.Advance();
  });
  std::vector<EpisodeFilm> films;
  for (std::optional<EpisodeFilm>& film : taken) {
    if (film) films.push_back(std::move(*film));
  }
  return films;
}

std::vector<ReportGrasp> TakeGraspPictures(const FinishedTrials& finished,
                                           const TrialPolicies& policies, int threads) {
  const std::vector<GraspToShow> shown = GraspsToShow(finished.rows);
  std::vector<PolicySet> sets;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    sets.push_back(policies.make());
    if (!sets.back().grasp || !sets.back().grasp->Explains()) return {};
  }
  std::vector<std::optional<ReportPicture>> pictures(shown.size());
  ParallelFor(shown.size(), threads, [&](std::size_t i) {
    for (const std::size_t trial : shown[i].trials) {
      pictures[i] = GraspPicture(finished, trial, sets[i]);
      if (pictures[i]) break;
    }
  });
  std::vector<ReportGrasp> grasps;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (pictures[i])
      grasps.push_back({shown[i].category, shown[i].opened, std::move(*pictures[i])});
  }
  return grasps;
}

ReportPictures TakePictures(const FinishedTrials& finished, const TrialPolicies& policies,
                            int threads) {
  ReportPictures pictures;
  TakeDoorPictures(finished, threads, pictures);
  const std::vector<std::size_t> trials = TrialsToFilm(finished.rows);
  std::vector<PolicySet> sets;
  for (std::size_t i = 0; i < trials.size(); ++i) sets.push_back(policies.make());
  std::vector<FilmedTrial> films(trials.size());
  ParallelFor(trials.size(), threads,
              [&](std::size_t i) { films[i] = FilmTrial(finished, trials[i], sets[i], policies); });
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (films[i].film.frames.empty()) continue;
    pictures.episodes[finished.rows[trials[i]].outcome] = std::move(films[i].film);
    if (films[i].first_decision && pictures.cloud.png.empty())
      AddSight(finished, trials[i], *films[i].first_decision, pictures);
  }
  pictures.grasps = TakeGraspPictures(finished, policies, threads);
  return pictures;
}

}  // namespace doorforge
