// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "doorforge/schemas/episode.h"
#include "doorforge/sensor/picture.h"

namespace doorforge {

struct EpisodeSheetConfig {
  std::uint64_t seed = 1;  ///< The scenes are drawn from it.
  int frames = 7;          ///< Each strip has so many.
  int width = 0;    ///< Each picture has so many pixels across; 0: 320, or 200 for several doors.
  int threads = 0;  ///< 0: all processors.
};

/// Film strips of the expert, and how each episode ended.
struct EpisodeSheet {
  Picture picture;
  std::vector<EpisodeOutcome> outcomes;  ///< One a door, in their order.
};

/// Lets the expert open the door in each folder and draws film strips: one door from three views,
/// several a row each. Throws Error(kInvalidArgument) for the folder of a part, else as ReadDoor().
EpisodeSheet DrawEpisodeSheet(std::span<const std::filesystem::path> doors,
                              const EpisodeSheetConfig& config);

/// "<folder's name>: <how it ended>", a line a door.
std::string OutcomesText(std::span<const std::filesystem::path> doors, const EpisodeSheet& sheet);

}  // namespace doorforge
