// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/episode_sheet.h"

#include <string>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/progress.h"
#include "doorforge/rollout/episode_strip.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge {

EpisodeSheet DrawEpisodeSheet(std::span<const std::filesystem::path> doors,
                              const EpisodeSheetConfig& config) {
  EpisodeStripConfig strip;
  strip.seed = config.seed;
  strip.frames = config.frames;
  strip.tile_px = config.width > 0 ? config.width : (doors.size() > 1 ? 200 : 320);
  const RobotModel robot = LoadMobileFranka();
  std::vector<EpisodeStrip> strips(doors.size());
  std::vector<std::string> titles(doors.size());
  Progress progress("opening", doors.size());
  ParallelFor(doors.size(), config.threads, [&](std::size_t i) {
    if (!std::filesystem::exists(doors[i] / "door.json"))
      throw Error(ErrorCode::kInvalidArgument,
                  doors[i].string() + ": is a part; --episode opens doors (`doorforge compose`)");
    const DoorAsset door = ReadDoor(doors[i]);
    strips[i] = DrawEpisode(door, robot, strip);
    titles[i] = std::string(NameOf(door.category)) + ", " + std::string(NameOf(door.mechanism));
    progress.Advance();
  });
  EpisodeSheet sheet;
  sheet.picture = strips.size() == 1 ? StripPicture(strips[0]) : StripSheet(strips, titles);
  for (const EpisodeStrip& drawn : strips) sheet.outcomes.push_back(drawn.episode.outcome);
  return sheet;
}

std::string OutcomesText(std::span<const std::filesystem::path> doors, const EpisodeSheet& sheet) {
  std::string text;
  for (std::size_t i = 0; i < doors.size(); ++i)
    text += doors[i].filename().string() + ": " + std::string(NameOf(sheet.outcomes[i])) + "\n";
  return text;
}

}  // namespace doorforge
