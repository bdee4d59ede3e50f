// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace doorforge {

struct EpisodeSheetOptions {
  std::filesystem::path out;  ///< PNG file.
  std::uint64_t seed = 1;
  int frames = 7;
  int width = 0;  ///< Of each picture; 0: 320, or 200 for several doors.
  int threads = 0;
};

/// Lets the expert open each door and draws the film strips: one door from three views, several a
/// row each. Prints how each episode ended.
void WriteEpisodeSheet(std::span<const std::filesystem::path> doors,
                       const EpisodeSheetOptions& options);

}  // namespace doorforge
