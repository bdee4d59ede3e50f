// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "doorforge/rollout/observer.h"
#include "doorforge/schemas/episode_film.h"

namespace doorforge {

/// Films an episode, about six instants a second, and hands on what another observer sees. The
/// episode goes as it does without.
class FilmRecorder : public Observer {
 public:
  /// @param camera Whom clouds are asked from; may be null: then policies see an empty one.
  explicit FilmRecorder(Observer* camera = nullptr) : camera_(camera) {}

  /// Clouds are asked from this camera from now on.
  void LookThrough(Observer* camera) { camera_ = camera; }

  LabelledCloud Observe(const SceneSnapshot& snapshot) override;
  void Watch(const SceneSnapshot& snapshot) override;
  bool Follows() const override { return true; }
  void Follow(const SceneSnapshot& snapshot) override;
  std::any Save() const override;
  void Restore(const std::any& memory) override;

  /// The film of the episode that was watched.
  EpisodeFilm Film(const Episode& episode) const;

 private:
  struct Instant {
    FilmInstant shown;
    Eigen::Vector3d hand_m = Eigen::Vector3d::Zero();
    EpisodePhase phase = EpisodePhase::kStart;
    bool named = false;  ///< The phase is known.
  };
  struct Memory {
    std::vector<Instant> instants;
    std::any camera;
  };

  void Add(const SceneSnapshot& snapshot, bool named);

  Observer* camera_;
  std::vector<Instant> instants_;
};

}  // namespace doorforge
