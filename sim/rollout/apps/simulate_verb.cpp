// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate_verb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/output_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/core/record_id.h"
#include "doorforge/rollout/run_episode.h"
#include "doorforge/rollout/standing_place.h"
#include "doorforge/schemas/door_set.h"

#include "film.h"
#include "doorforge/robot_meshes/robot_meshes.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kDegree = 3.141592653589793 / 180;

struct Row {
  std::size_t door = 0;
  std::uint64_t seed = 0;
  int episode = 0;
  std::optional<Episode> result;
};

struct Interval {
  double low;
  double high;
};

// Wilson's score interval at 95 %.
Interval WilsonInterval(int successes, int count) {
  constexpr double kZ = 1.959963984540054;
  if (count == 0) return {0, 1};
  const double n = count;
  const double p = successes / n;
  const double middle = (p + kZ * kZ / (2 * n)) / (1 + kZ * kZ / n);
  const double half = kZ / (1 + kZ * kZ / n) * std::sqrt(p * (1 - p) / n + kZ * kZ / (4 * n * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::vector<Row> PlanRows(const SimulateOptions& options, std::size_t doors) {
  std::vector<Row> rows;
  for (std::size_t door = 0; door < doors; ++door) {
    for (int seed = 0; seed < options.seeds; ++seed) {
      for (int episode = 0; episode < options.episodes; ++episode)
        rows.push_back({door, options.seed + static_cast<std::uint64_t>(seed), episode, {}});
    }
  }
  return rows;
}

std::string NameOf(const Row& row, const std::string& door) {
  return door + "_seed" + std::to_string(row.seed) + "_" + std::to_string(row.episode);
}

fs::path PictureOf(const SimulateOptions& options, const Row& row, const std::string& door) {
  return OutputBelow(options.film, NameOf(row, door) + ".png");
}

// Before hours of work, not after.
void RequireNoPictures(const SimulateOptions& options, const std::vector<Row>& rows,
                       const std::vector<FoundDoor>& doors) {
  if (options.film.empty()) return;
  for (const Row& row : rows)
    RequireNoFile(PictureOf(options, row, doors[row.door].identity.id), options.overwrite);
}

void RunRow(const SimulateOptions& options, const DoorAsset& door, const RobotModel& robot,
            Row& row) {
  const Scene scene = SceneFor(
      robot,
      SampleScene(door, row.seed, static_cast<std::uint64_t>(row.episode), options.config.scene),
      door);
  std::unique_ptr<Film> film;
  if (!options.film.empty()) film = std::make_unique<Film>(scene, door, robot);
  OpeningExpert expert(options.config.expert);
  Episode episode = RunEpisode(scene, door, robot, expert, film.get());
  if (film) film->Write(PictureOf(options, row, door.id));
  for (Decision& decision : episode.decisions) decision.cloud = {};
  row.result = std::move(episode);
}

Json RowToJson(const Row& row, const DoorIdentity& door) {
  const Episode& episode = *row.result;
  return {{"door", door.id},
          {"category", NameOf(door.category)},
          {"mechanism", NameOf(door.mechanism)},
          {"seed", row.seed},
          {"episode", row.episode},
          {"outcome", NameOf(episode.outcome)},
          {"detail", episode.detail},
          {"peak_hinge_deg", episode.peak_hinge_rad / kDegree},
          {"peak_handle_deg", episode.peak_handle_rad / kDegree},
          {"actions", episode.decisions.size()},
          {"simulated_s", episode.simulated_s},
          {"state_sha256", episode.state_sha256}};
}

struct Tally {
  int episodes = 0;
  std::map<std::string, int> outcomes;

  int opened() const {
    const auto found = outcomes.find(std::string(NameOf(EpisodeOutcome::kOpened)));
    return found == outcomes.end() ? 0 : found->second;
  }
};

Json TallyToJson(const Tally& tally) {
  const Interval interval = WilsonInterval(tally.opened(), tally.episodes);
  return {
      {"rate", tally.episodes == 0 ? 0.0 : static_cast<double>(tally.opened()) / tally.episodes},
      {"low", interval.low},
      {"high", interval.high},
      {"episodes", tally.episodes},
      {"outcomes", tally.outcomes}};
}

std::map<std::string, Tally> Tallies(const std::vector<Row>& rows,
                                     const std::vector<FoundDoor>& doors) {
  std::map<std::string, Tally> tallies;
  for (const Row& row : rows) {
    if (!row.result) continue;
    for (const std::string& group :
         {std::string("overall"), std::string(NameOf(doors[row.door].identity.category))}) {
      ++tallies[group].episodes;
      ++tallies[group].outcomes[std::string(NameOf(row.result->outcome))];
    }
  }
  return tallies;
}

void PrintText(const std::vector<Row>& rows, const std::vector<FoundDoor>& doors) {
  for (const Row& row : rows) {
    if (!row.result) continue;
    std::cout << NameOf(row, doors[row.door].identity.id) << ": " << NameOf(row.result->outcome)
              << " (" << row.result->detail << ")\n";
  }
  for (const auto& [group, tally] : Tallies(rows, doors)) {
    const Interval interval = WilsonInterval(tally.opened(), tally.episodes);
    const auto percent = [](double part) { return std::to_string(std::lround(100 * part)); };
    std::cout << group << ": opened " << tally.opened() << " of " << tally.episodes
              << " (95 %: " << percent(interval.low) << " to " << percent(interval.high) << " %)";
    for (const auto& [outcome, count] : tally.outcomes)
      std::cout << ", " << outcome << " " << count;
    std::cout << "\n";
  }
}

void PrintJson(const std::vector<Row>& rows, const std::vector<FoundDoor>& doors) {
  Json json = {{"schema", "doorforge.simulate"},
               {"schema_version", 1},
               {"success", Json::object()},
               {"episodes", Json::array()}};
  for (const auto& [group, tally] : Tallies(rows, doors))
    json["success"][group] = TallyToJson(tally);
  for (const Row& row : rows) {
    if (row.result) json["episodes"].push_back(RowToJson(row, doors[row.door].identity));
  }
  std::cout << JsonText(json, 2) << "\n";
}

}  // namespace

int Simulate(const SimulateOptions& options) {
  const std::vector<FoundDoor> doors =
      FindDoorSet({.folders = options.doors}, options.threads).doors;
  DoorShelf shelf(doors);
  const RobotModel robot = LoadRobot(
      options.config.scene.robot, RobotBaseNamed(options.config.scene.physics.base), RobotMeshes());
  std::vector<Row> rows = PlanRows(options, doors.size());
  RequireNoPictures(options, rows, doors);
  Progress progress("simulating", rows.size());
  ParallelFor(rows.size(), options.threads, [&](std::size_t i) {
    if (StopRequested() != 0) return;
    RunRow(options, *shelf.Take(rows[i].door), robot, rows[i]);
    progress.Advance();
  });
  if (options.json) {
    PrintJson(rows, doors);
  } else {
    PrintText(rows, doors);
  }
  if (StopRequested() != 0) return 128 + StopRequested();
  const Tally all = Tallies(rows, doors)["overall"];
  return all.opened() == all.episodes ? 0 : 1;
}

}  // namespace doorforge
