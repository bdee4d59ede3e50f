// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "episode_sheet.h"

#include <cstdio>
#include <string>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/progress.h"
#include "doorforge/rollout/episode_strip.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge {

void WriteEpisodeSheet(std::span<const std::filesystem::path> doors,
                       const EpisodeSheetOptions& options) {
  EpisodeStripConfig config;
  config.seed = options.seed;
  config.frames = options.frames;
  config.tile_px = options.width > 0 ? options.width : (doors.size() > 1 ? 200 : 320);
  const RobotModel robot = LoadMobileFranka();
  std::vector<EpisodeStrip> strips(doors.size());
  std::vector<std::string> titles(doors.size());
  Progress progress("opening", doors.size());
  ParallelFor(doors.size(), options.threads, [&](std::size_t i) {
    if (!std::filesystem::exists(doors[i] / "door.json"))
      throw Error(ErrorCode::kInvalidArgument,
                  doors[i].string() + ": is a part; --episode opens doors (`doorforge compose`)");
    const DoorAsset door = ReadDoor(doors[i]);
    strips[i] = DrawEpisode(door, robot, config);
    titles[i] = std::string(NameOf(door.category)) + ", " + std::string(NameOf(door.mechanism));
    progress.Advance();
  });
  WritePng(options.out, strips.size() == 1 ? StripPicture(strips[0]) : StripSheet(strips, titles));
  for (std::size_t i = 0; i < strips.size(); ++i)
    std::printf("%s: %s\n", doors[i].filename().c_str(),
                std::string(NameOf(strips[i].episode.outcome)).c_str());
}

}  // namespace doorforge
