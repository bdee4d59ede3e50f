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
          .phase = {},
          .robot = {joints.data(), joints.data() + joints.size()},
          .hinge_rad = snapshot.hinge_rad,
          .handle_rad = snapshot.handle_rad,
          .bolt_m = snapshot.bolt_m,
          .force_n = snapshot.force_n,
          .net_force_n = snapshot.net_force_n};
}

// The phase in which an episode ended that was not watched to its end.
EpisodePhase After(EpisodePhase phase) {
  return phase == EpisodePhase::kEnd ? phase
                                     : static_cast<EpisodePhase>(static_cast<int>(phase) + 1);
}

}  // namespace

LabelledCloud FilmRecorder::Observe(const SceneSnapshot& snapshot) {
  return camera_ != nullptr ? camera_->Observe(snapshot) : LabelledCloud{};
}

void FilmRecorder::Watch(const SceneSnapshot& snapshot) {
  if (camera_ != nullptr) camera_->Watch(snapshot);
  // what was followed until now led here
  for (Instant& before : instants_) {
    if (!before.named) before.phase = snapshot.phase;
    before.named = true;
  }
  const bool again =
      !instants_.empty() && std::abs(instants_.back().shown.time_s - snapshot.time_s) < kSameTime;
  if (again) instants_.pop_back();
  Add(snapshot, true);
}

void FilmRecorder::Follow(const SceneSnapshot& snapshot) {
  if (!instants_.empty() && snapshot.time_s - instants_.back().shown.time_s < kNear) return;
  Add(snapshot, false);
}

void FilmRecorder::Add(const SceneSnapshot& snapshot, bool named) {
  instants_.push_back(
      {InstantOf(snapshot), snapshot.robot.world_from_hand.translation(), snapshot.phase, named});
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
  EpisodePhase last = EpisodePhase::kStart;
  for (const Instant& instant : instants_) {
    if (instant.named) last = instant.phase;
    film.instants.push_back(instant.shown);
    film.instants.back().phase = NameOf(instant.named ? last : After(last));
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
