// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "doorforge/rollout/proprioception.h"
#include "doorforge/schemas/episode.h"

#include "film.h"

namespace doorforge::internal {

/// Forces for episodes that are stored without, from films of the same episodes.
class FilmForces {
 public:
  /// @param robot Of the episodes, on their base.
  /// @throws Error(kMissing, kIo or kFormat) as ReadFilms().
  FilmForces(std::filesystem::path file, const RobotModel& robot);

  /// Gives the frames of `film`, one a stored state, the forces of the film of this scene in which
  /// all joints are, at the time of each frame, those of the state to 1e-6; and a fact that says
  /// so.
  ///
  /// @return Why there are none, with the first number that differs; empty: there are.
  std::string AddTo(Film& film, const Scene& scene, std::span<const JointState> states);

 private:
  std::filesystem::path file_;
  std::size_t joints_;
  ProprioceptionPlaces places_;
  std::multimap<std::string, EpisodeFilm> films_;  // by FilmAddress(): stages share it
};

}  // namespace doorforge::internal
