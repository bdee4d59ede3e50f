// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/film_recorder.h"

#include <cmath>

namespace doorforge {
namespace {

constexpr double kNear = 0.1;       // [s] instants that nobody asked for keep this distance
constexpr double kSameTime = 1e-9;  // [s]

FilmInstant InstantOf(const SceneSnapshot& snapshot) {
  const JointVector& joints = snapshot.robot_position;
  return {.time_s = snapshot.time_s,
          .phase = std::string(NameOf(snapshot.phase)),
          .robot = {joints.data(), joints.data() + joints.size()},
          .hinge_rad = snapshot.hinge_rad,
          .handle_rad = snapshot.handle_rad,
          .bolt_m = snapshot.bolt_m,
          .force_n = snapshot.force_n,
          .net_force_n = snapshot.net_force_n};
}

}  // namespace

LabelledCloud FilmRecorder::Observe(const SceneSnapshot& snapshot) {
  return camera_ != nullptr ? camera_->Observe(snapshot) : LabelledCloud{};
}

void FilmRecorder::Watch(const SceneSnapshot& snapshot) {
  if (camera_ != nullptr) camera_->Watch(snapshot);
  Instant instant{InstantOf(snapshot), snapshot.robot.world_from_hand.translation(), true};
  // what was followed until now led here
  for (Instant& before : instants_) {
    if (!before.named) before.shown.phase = instant.shown.phase;
    before.named = true;
  }
  if (!instants_.empty() && std::abs(instants_.back().shown.time_s - snapshot.time_s) < kSameTime)
    instants_.back() = std::move(instant);
  else
    instants_.push_back(std::move(instant));
}

void FilmRecorder::Follow(const SceneSnapshot& snapshot) {
  if (!instants_.empty() && snapshot.time_s - instants_.back().shown.time_s < kNear) return;
  instants_.push_back({InstantOf(snapshot), snapshot.robot.world_from_hand.translation(), false});
}

std::any FilmRecorder::Save() const {
  return Memory{instants_, camera_ != nullptr ? camera_->Save() : std::any()};
}

void FilmRecorder::Restore(const std::any& memory) {
  const auto& saved = std::any_cast<const Memory&>(memory);
  instants_ = saved.instants;
  if (camera_ != nullptr) camera_->Restore(saved.camera);
}

EpisodeFilm FilmRecorder::Film(const Episode& episode) const {
  EpisodeFilm film{episode.scene, episode.outcome, episode.detail, episode.state_sha256, {}};
  auto decision = episode.decisions.begin();
  for (const Instant& instant : instants_) {
    film.instants.push_back(instant.shown);
    while (decision != episode.decisions.end() &&
           decision->time_s < instant.shown.time_s - kSameTime)
      ++decision;
    if (decision == episode.decisions.end() || decision->time_s > instant.shown.time_s + kSameTime)
      continue;
    const ActionVector& action = decision->action;
    film.instants.back().asked_m =
        instant.hand_m + Eigen::Vector3d(action[0], action[1], action[2]);
  }
  return film;
}

}  // namespace doorforge
