// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/collect/forecast.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/progress.h"
#include "doorforge/schemas/episode_arrays.h"

namespace doorforge {
namespace {

// What one episode of the probe came to.
struct Measured {
  double decisions = 0;
  double bytes = 0;
};

// In a tar every member has a header of 512 bytes and is filled up to a multiple of that.
double TarBytes(const MemberBytes& member) {
  constexpr std::size_t kBlock = 512;
  return static_cast<double>(kBlock + (member.bytes.size() + kBlock - 1) / kBlock * kBlock);
}

Measured Measure(StageRun& run, const PlannedEpisode& planned) {
  Measured measured;
  const CollectedEpisode collected = run.Run(planned);
  if (!IsData(collected)) return measured;
  measured.decisions = static_cast<double>(collected.episode.decisions.size());
  for (const MemberBytes& member : MembersOf(collected)) measured.bytes += TarBytes(member);
  return measured;
}

// As Collect() counts: an episode that cannot be run is a failed one.
Measured MeasureOrFail(StageRun& run, const PlannedEpisode& planned) {
  try {
    return Measure(run, planned);
  } catch (const Error&) {
    return {};
  }
}

std::vector<const PlannedEpisode*> EvenlyFrom(const CollectionPlan& plan, std::size_t count) {
  std::vector<const PlannedEpisode*> all;
  for (const PlannedShard& shard : plan.shards) {
    for (const PlannedEpisode& episode : shard.episodes) all.push_back(&episode);
  }
  std::sort(all.begin(), all.end(),
            [](const auto* a, const auto* b) { return a->number < b->number; });
  std::vector<const PlannedEpisode*> chosen;
  count = std::min(count, all.size());
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(all[i * all.size() / count]);
  return chosen;
}

void Probe(StageRun& run, std::size_t count, CollectionForecast& forecast) {
  const std::vector<const PlannedEpisode*> episodes = EvenlyFrom(run.plan(), count);
  std::vector<Measured> measured(episodes.size());
  Progress progress("probe", episodes.size());
  const auto begin = std::chrono::steady_clock::now();
  ParallelFor(episodes.size(), forecast.threads, [&](std::size_t i) {
    measured[i] = MeasureOrFail(run, *episodes[i]);
    progress.Advance();
  });
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  const double scale =
      static_cast<double>(forecast.episodes) / static_cast<double>(episodes.size());
  forecast.probed = static_cast<int>(episodes.size());
  forecast.seconds = scale * taken.count();
  for (const Measured& one : measured) {
    forecast.written_episodes += one.decisions > 0 ? scale : 0;
    forecast.decisions += scale * one.decisions;
    forecast.bytes += scale * one.bytes;
  }
}

std::string Line(const char* format, double value) {
  char text[160];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string TimeText(double seconds) {
  if (seconds < 120) return Line("%.0f s", seconds);
  if (seconds < 7200) return Line("%.0f min", seconds / 60);
  return Line("%.1f h", seconds / 3600);
}

}  // namespace

CollectionForecast Forecast(StageRun& run, int probe, int threads) {
  CollectionForecast forecast;
  forecast.stage = NameOf(run.config().stage);
  forecast.threads = ThreadCount(threads);
  forecast.shards = run.plan().shards.size();
  for (const FoundDoor& door : run.doors())
    ++forecast.doors_by_category[std::string(NameOf(door.identity.category))];
  for (const PlannedShard& shard : run.plan().shards) {
    forecast.episodes += shard.episodes.size();
    for (const PlannedEpisode& episode : shard.episodes)
      ++forecast
            .episodes_by_category[std::string(NameOf(run.doors()[episode.door].identity.category))];
  }
  if (probe > 0) Probe(run, static_cast<std::size_t>(probe), forecast);
  return forecast;
}

nlohmann::ordered_json ForecastToJson(const CollectionForecast& forecast) {
  nlohmann::ordered_json json = {{"schema", "doorforge.collection_forecast"},
                                 {"schema_version", 1},
                                 {"stage", forecast.stage},
                                 {"episodes", forecast.episodes},
                                 {"shards", forecast.shards},
                                 {"doors_by_category", forecast.doors_by_category},
                                 {"episodes_by_category", forecast.episodes_by_category},
                                 {"threads", forecast.threads},
                                 {"probed_episodes", forecast.probed}};
  if (forecast.probed > 0)
    json["expected"] = {{"written_episodes", forecast.written_episodes},
                        {"decisions", forecast.decisions},
                        {"bytes", forecast.bytes},
                        {"wall_s", forecast.seconds}};
  return json;
}

std::string ForecastText(const CollectionForecast& forecast) {
  char text[160];
  std::snprintf(text, sizeof text, "stage %s: %llu episodes in %llu shards\n\n%-17s %8s  %8s\n",
                forecast.stage.c_str(), static_cast<unsigned long long>(forecast.episodes),
                static_cast<unsigned long long>(forecast.shards), "category", "doors", "episodes");
  std::string table = text;
  for (const auto& [category, doors] : forecast.doors_by_category) {
    const auto found = forecast.episodes_by_category.find(category);
    const auto episodes = found == forecast.episodes_by_category.end() ? 0 : found->second;
    std::snprintf(text, sizeof text, "%-17s %8llu  %8llu\n", category.c_str(),
                  static_cast<unsigned long long>(doors),
                  static_cast<unsigned long long>(episodes));
    table += text;
  }
  if (forecast.probed == 0) return table + "\nnothing was measured (--probe 0)\n";
  std::snprintf(text, sizeof text, "\nexpected, from %d of these episodes, run on %d threads:\n",
                forecast.probed, forecast.threads);
  table += text;
  table += Line("  written episodes  %.0f\n", forecast.written_episodes);
  table += Line("  decisions         %.0f\n", forecast.decisions);
  table += Line("  on disk           %.2f GB\n", forecast.bytes / 1e9);
  return table + "  time              " + TimeText(forecast.seconds) + "\n";
}

}  // namespace doorforge
