// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// Where everything is at an instant of an episode, and what the robot does to the door.
struct FilmInstant {
  double time_s = 0;
  std::string phase = {};     ///< "start", "reach", "grasp", "unlock", "open" or "end".
  std::vector<double> robot;  ///< Its joints in their order [m or rad].
  double hinge_rad = 0;
  double handle_rad = 0;
  double bolt_m = 0;       ///< 0 thrown, negative drawn back; 0 where there is none.
  double force_n = 0;      ///< Sum of the normal forces between robot and door in this step.
  double net_force_n = 0;  ///< Length of the sum of all forces of the robot on the door in it.
  /// Where the policy asks the hand to go, in the world [m]; empty where none decides.
  std::optional<Eigen::Vector3d> asked_m = std::nullopt;
};

/// An episode to be looked at: with the scene's poses of door and robot the instants say where
/// everything was.
struct EpisodeFilm {
  Scene scene;
  EpisodeOutcome outcome = EpisodeOutcome::kDiverged;
  std::string detail;                 ///< The numbers that explain the outcome, for people.
  std::string state_sha256;           ///< Episode::state_sha256.
  std::vector<FilmInstant> instants;  ///< In the order of time.
};

/// What pages call an episode, and its anchor there: "<door>/<seed>/<number>".
std::string FilmAddress(const Scene& scene);
std::string FilmAddress(const std::string& door_id, std::uint64_t seed, std::uint64_t episode);

/// {"schema": "doorforge.film", ...} as docs/format-report.md describes it; numbers of the instants
/// have six decimals.
nlohmann::ordered_json FilmToJson(const EpisodeFilm& film);

/// Throws Error(kFormat), `path` names the record.
EpisodeFilm FilmFromJson(const nlohmann::ordered_json& json, const std::string& path);

/// Writes one film a line. Throws Error(kIo) as CommitFile().
void WriteFilms(const std::filesystem::path& path, std::span<const EpisodeFilm> films);

/// Throws Error(kMissing or kIo) where it cannot be read, Error(kFormat) that names the line.
std::vector<EpisodeFilm> ReadFilms(const std::filesystem::path& path);

}  // namespace doorforge
