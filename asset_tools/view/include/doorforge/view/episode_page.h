// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "doorforge/view/robot_source.h"
#include "doorforge/view/view_page.h"

namespace doorforge {

/// Which episodes of a data set are shown, and how.
struct DatasetEpisodes {
  std::filesystem::path dataset;                 ///< Folder with a dataset.json.
  std::span<const std::filesystem::path> doors;  ///< Folders that hold its doors.
  std::string stage = {};                        ///< "open", "handle" or "grasp"; empty: all.
  std::string key = {};  ///< One episode, such as "ep000012"; empty: the first ones.
  int most = 12;         ///< At most so many, at least 1.
  int points = 1024;  ///< Each cloud shows so many, evenly drawn from those stored; 0: no clouds.
  int threads = 0;    ///< 0: all processors.
  ShownRobot robot = {};
  std::filesystem::path films =
      {};  ///< `dataset films --stored` wrote it; empty: no forces are shown.
};

/// Shows episodes of a data set as they were stored: robot and door at each decision, the cloud in
/// the colours of its labels, the action, hinge and handle over time, what was hidden. Forces are
/// not stored: they are those of a film of the episode where all its joints are, at each decision,
/// those stored, to 1e-6 (what a film keeps); else there are none, and a message. Episodes of which
/// the door is not found, or has changed since, and those of another robot than the one that is
/// given, are left out with a message.
///
/// @throws Error(kMissing) if there is no data set, no door of it, or no episode to show;
/// Error(kFormat)
///     on shards without states, as builds of before wrote them; else as ReadFilms() and
///     ShardReader.
ViewPage MakeDatasetPage(const DatasetEpisodes& chosen);

/// How the rule-based expert's episodes are made.
struct ExpertEpisodes {
  std::uint64_t seed = 1;
  int points = 1024;  ///< Each cloud shows so many; 0: none.
  int threads = 0;    ///< 0: all processors.
  ShownRobot robot = {};
};

/// Lets the rule-based expert open the door in each folder and shows how. Deterministic. A door
/// that cannot be read or simulated is left out with its fault.
///
/// @throws Error(kInvalidArgument) if none of the folders is a door that can be simulated.
ViewPage MakeExpertPage(std::span<const std::filesystem::path> doors,
                        const ExpertEpisodes& config = {});

}  // namespace doorforge
