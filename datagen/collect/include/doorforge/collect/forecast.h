// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "doorforge/collect/stage_run.h"

namespace doorforge {

/// What a collection would be. The last four numbers follow from `probed` episodes of it that were
/// run; without any they are 0.
struct CollectionForecast {
  std::string stage;
  std::uint64_t episodes = 0;  ///< Planned, failed ones included.
  std::uint64_t shards = 0;
  std::map<std::string, std::uint64_t> doors_by_category;
  std::map<std::string, std::uint64_t> episodes_by_category;
  int threads = 0;
  int probed = 0;
  double written_episodes = 0;  ///< Expected number that become data.
  double decisions = 0;         ///< Samples.
  double bytes = 0;             ///< The shards take so much room.
  double seconds = 0;           ///< It takes so much wall-clock time with this many threads.
};

/// Counts the plan and runs `probe` of its episodes, evenly from the plan, on `threads` threads (0:
/// all processors). Writes nothing.
CollectionForecast Forecast(StageRun& run, int probe, int threads);

/// {"schema": "doorforge.collection_forecast", "schema_version", ...}
nlohmann::ordered_json ForecastToJson(const CollectionForecast& forecast);
/// Says it for people.
std::string ForecastText(const CollectionForecast& forecast);

}  // namespace doorforge
