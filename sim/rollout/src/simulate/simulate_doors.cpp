// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/simulate_doors.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "doorforge/core/output_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/core/record_id.h"
#include "doorforge/core/wilson_interval.h"
#include "doorforge/physics/door_world.h"
#include "doorforge/rollout/base_placement.h"
#include "doorforge/rollout/run_episode.h"

#include "simulate/film.h"
#include "text_format.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// An episode to come: its door's place in the set, and what it gave once it has run.
struct Row {
  std::size_t door = 0;
  SimulatedEpisode simulated;
  bool done = false;
};

std::vector<Row> PlanRows(const SimulationRun& run, const std::vector<FoundDoor>& doors) {
  std::vector<Row> rows;
  for (std::size_t door = 0; door < doors.size(); ++door) {
    for (int seed = 0; seed < run.seeds; ++seed) {
      for (int index = 0; index < run.episodes; ++index)
        rows.push_back(
            {door, {doors[door].identity, run.seed + static_cast<std::uint64_t>(seed), index, {}}});
    }
  }
  return rows;
}

fs::path PictureOf(const SimulationRun& run, const SimulatedEpisode& episode) {
  return OutputBelow(run.film, NameOf(episode) + ".png");
}

// Before hours of work, not after.
void RequireNoPictures(const SimulationRun& run, const std::vector<Row>& rows) {
  if (run.film.empty()) return;
  for (const Row& row : rows) RequireNoFile(PictureOf(run, row.simulated), run.overwrite);
}

void RunRow(const SimulationRun& run, const IdentifiedDoor& identified, const RobotModel& robot,
            SimulatedEpisode& simulated) {
  const DoorAsset& door = *identified;
  const Scene scene =
      PlaceRobotBase(robot,
                     SampleScene(identified, simulated.seed,
                                 static_cast<std::uint64_t>(simulated.index), run.config.scene),
                     door);
  std::unique_ptr<Film> film;
  if (!run.film.empty()) film = std::make_unique<Film>(scene, door, robot);
  if (run.run_episode) {
    simulated.episode = run.run_episode(scene, door, robot, film.get());
  } else {
    OpeningExpert expert(run.config.expert);
    simulated.episode = RunEpisode(scene, door, robot, expert, film.get());
  }
  if (film) film->Write(PictureOf(run, simulated));
  for (Decision& decision : simulated.episode.decisions) decision.cloud = {};
}

Json EpisodeToJson(const SimulatedEpisode& simulated) {
  const Episode& episode = simulated.episode;
  return {{"door", simulated.door.id},
          {"category", NameOf(simulated.door.category)},
          {"mechanism", NameOf(simulated.door.mechanism)},
          {"seed", simulated.seed},
          {"episode", simulated.index},
          {"outcome", NameOf(episode.outcome)},
          {"detail", episode.detail},
          {"peak_hinge_deg", episode.peak_hinge_rad / internal::kDegree},
          {"peak_handle_deg", episode.peak_handle_rad / internal::kDegree},
          {"actions", episode.decisions.size()},
          {"simulated_s", episode.simulated_s},
          {"state_sha256", episode.state_sha256}};
}

void SetInterval(OutcomeTally& tally) {
  const Interval interval = WilsonInterval(tally.opened, tally.episodes);
  tally.low = interval.low;
  tally.high = interval.high;
}

Json TallyToJson(const OutcomeTally& tally) {
  return {{"rate", tally.episodes == 0 ? 0.0 : static_cast<double>(tally.opened) / tally.episodes},
          {"low", tally.low},
          {"high", tally.high},
          {"episodes", tally.episodes},
          {"outcomes", tally.outcomes}};
}

}  // namespace

std::string NameOf(const SimulatedEpisode& episode) {
  return episode.door.id + "_seed" + std::to_string(episode.seed) + "_" +
         std::to_string(episode.index);
}

std::vector<SimulatedEpisode> SimulateDoors(const SimulationRun& run) {
  RequireSimulator(run.config.scene.physics.simulator);
  const std::vector<FoundDoor> doors = FindDoorSet({.folders = run.doors}, run.threads).doors;
  DoorCache shelf(doors);
  const RobotModel robot =
      LoadRobot(run.config.scene.robot, run.config.scene.physics.base, run.read_meshes);
  std::vector<Row> rows = PlanRows(run, doors);
  RequireNoPictures(run, rows);
  Progress progress("simulating", rows.size());
  ParallelFor(rows.size(), run.threads, [&](std::size_t i) {
    if (StopRequested() != 0) return;
    RunRow(run, shelf.Take(rows[i].door), robot, rows[i].simulated);
    rows[i].done = true;
    progress.Advance();
  });
  std::vector<SimulatedEpisode> episodes;
  for (Row& row : rows) {
    if (row.done) episodes.push_back(std::move(row.simulated));
  }
  return episodes;
}

std::map<std::string, OutcomeTally> TallyOutcomes(std::span<const SimulatedEpisode> episodes) {
  std::map<std::string, OutcomeTally> tallies;
  for (const SimulatedEpisode& simulated : episodes) {
    const EpisodeOutcome outcome = simulated.episode.outcome;
    for (const std::string& group :
         {std::string("overall"), std::string(NameOf(simulated.door.category))}) {
      OutcomeTally& tally = tallies[group];
      ++tally.episodes;
      tally.opened += outcome == EpisodeOutcome::kOpened ? 1 : 0;
      ++tally.outcomes[std::string(NameOf(outcome))];
    }
  }
  for (auto& [group, tally] : tallies) SetInterval(tally);
  return tallies;
}

Json SimulatedToJson(std::span<const SimulatedEpisode> episodes) {
  Json json = {{"schema", "doorforge.simulate"},
               {"schema_version", 1},
               {"success", Json::object()},
               {"episodes", Json::array()}};
  for (const auto& [group, tally] : TallyOutcomes(episodes))
    json["success"][group] = TallyToJson(tally);
  for (const SimulatedEpisode& simulated : episodes)
    json["episodes"].push_back(EpisodeToJson(simulated));
  return json;
}

std::string SimulatedText(std::span<const SimulatedEpisode> episodes) {
  std::string text;
  for (const SimulatedEpisode& simulated : episodes)
    text += NameOf(simulated) + ": " + std::string(NameOf(simulated.episode.outcome)) + " (" +
            simulated.episode.detail + ")\n";
  for (const auto& [group, tally] : TallyOutcomes(episodes)) {
    const auto percent = [](double part) { return std::to_string(std::lround(100 * part)); };
    text += group + ": opened " + std::to_string(tally.opened) + " of " +
            std::to_string(tally.episodes) + " (95 %: " + percent(tally.low) + " to " +
            percent(tally.high) + " %)";
    for (const auto& [outcome, count] : tally.outcomes)
      text += ", " + outcome + " " + std::to_string(count);
    text += "\n";
  }
  return text;
}

std::size_t FailedAmong(std::span<const SimulatedEpisode> episodes) {
  return static_cast<std::size_t>(
      std::ranges::count_if(episodes, [](const SimulatedEpisode& simulated) {
        return simulated.episode.outcome != EpisodeOutcome::kOpened;
      }));
}

}  // namespace doorforge
