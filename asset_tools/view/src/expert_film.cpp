// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "expert_film.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/camera_observer.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/rollout/run_episode.h"

namespace doorforge::internal {
namespace {

double TurnOf(const DoorJoint& joint, const RigidTransform& parent, const RigidTransform& child) {
  const Eigen::Matrix3d turned = joint.parent_from_child_at_zero.linear().transpose() *
                                 parent.linear().transpose() * child.linear();
  return joint.axis.dot(RotationVector(turned));
}

// A frame whenever the episode shows itself.
class FilmRecorder final : public Observer {
 public:
  FilmRecorder(const DoorAsset& door, CameraObserver* camera) : door_(door), camera_(camera) {}

  LabelledCloud Observe(const SceneSnapshot& snapshot) override {
    if (camera_ == nullptr) return {};
    LabelledCloud cloud = camera_->Observe(snapshot);
    if (frames.empty() || frames.back().time_s != snapshot.time_s) Watch(snapshot);
    frames.back().cloud = cloud;
    return cloud;
  }

  void Watch(const SceneSnapshot& snapshot) override {
    FilmFrame frame;
    frame.time_s = snapshot.time_s;
    frame.phase = NameOf(snapshot.phase);
    frame.hinge_rad = TurnOf(door_.hinge, snapshot.door[kBaseLink], snapshot.door[kLeafLink]);
    frame.handle_rad =
        TurnOf(door_.handle_joint, snapshot.door[kLeafLink], snapshot.door[kHandleLink]);
    frame.poses = PosesOf(snapshot.door, snapshot.robot);
    frame.hand_m = snapshot.robot.world_from_hand.translation();
    if (!frames.empty() && frames.back().time_s == frame.time_s) {
      frame.cloud = std::move(frames.back().cloud);
      frames.back() = std::move(frame);
    } else {
      frames.push_back(std::move(frame));
    }
  }

  std::vector<FilmFrame> frames;

 private:
  const DoorAsset& door_;
  CameraObserver* camera_;
};

// Where the hand was asked to go, at the instants of the decisions.
void AddActions(const Episode& episode, std::vector<FilmFrame>& frames) {
  for (const Decision& decision : episode.decisions) {
    for (FilmFrame& frame : frames) {
      if (std::abs(frame.time_s - decision.time_s) < 1e-9)
        frame.asked_m = frame.hand_m +
                        Eigen::Vector3d(decision.action[0], decision.action[1], decision.action[2]);
    }
  }
}

std::string Text(const char* format, double number) {
  char text[64];
  std::snprintf(text, sizeof text, format, number);
  return text;
}

}  // namespace

Film FilmOfExpert(const DoorAsset& door, const RobotModel& robot, std::uint64_t seed,
                  bool with_cloud) {
  const Scene scene = SampleScene(door, seed, 0);
  std::optional<CameraObserver> camera;
  if (with_cloud) camera.emplace(scene, door, robot);
  FilmRecorder recorder(door, camera ? &*camera : nullptr);
  OpeningExpert expert;
  const Episode episode = RunEpisode(scene, door, robot, expert, &recorder);
  constexpr double kDegrees = 180 / std::numbers::pi;
  Film film;
  film.title = door.id;
  film.opened = episode.outcome == EpisodeOutcome::kOpened;
  film.facts = {{"Door", door.id},
                {"Outcome", std::string(NameOf(episode.outcome))},
                {"Detail", episode.detail},
                {"Seed", std::to_string(seed)},
                {"Greatest hinge angle", Text("%.1f deg", kDegrees * episode.peak_hinge_rad)},
                {"Greatest handle angle", Text("%.1f deg", kDegrees * episode.peak_handle_rad)},
                {"Greatest force", Text("%.0f N", episode.peak_force_n)},
                {"Simulated", Text("%.1f s", episode.simulated_s)}};
  film.frames = std::move(recorder.frames);
  AddActions(episode, film.frames);
  return film;
}

}  // namespace doorforge::internal
