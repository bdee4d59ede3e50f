// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/observer.h"
#include "doorforge/rollout/opening_expert.h"
#include "doorforge/schemas/door_set.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/sensor/point_cloud.h"

namespace doorforge {

/// What decides the episodes, beside doors and seeds.
struct SimulateConfig {
  SceneConfig scene;
  CloudConfig cloud;  ///< What policies that look see.
  OpeningExpertConfig expert;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("scene", self.scene);
    visit("cloud", self.cloud);
    visit("expert", self.expert);
  }
};

/// The episodes of every door: `episodes` of each of `seeds` seeds.
struct SimulationRun {
  std::vector<std::filesystem::path> doors;  ///< Folders with a door.json, or folders of them.
  SimulateConfig config;
  std::uint64_t seed = 1;            ///< The first of them; the others follow it.
  int seeds = 1;                     ///< Number of seeds, at least 1.
  int episodes = 1;                  ///< Each door has so many in each seed, at least 1.
  int threads = 0;                   ///< 0: all processors.
  std::filesystem::path film = {};   ///< Folder for a PNG of each episode; empty: no pictures.
  bool overwrite = false;            ///< Pictures that are there are replaced.
  RobotMeshReader read_meshes = {};  ///< Reads the meshes of a user's robot, see LoadRobot().
  /// Runs an episode that the observer, which may be null, is to see; called from several threads.
  /// Empty: the expert acts, as config.expert says.
  std::function<Episode(const Scene&, const DoorAsset&, const RobotModel&, Observer*)> run_episode =
      {};
};

struct SimulatedEpisode {
  DoorIdentity door;
  std::uint64_t seed = 0;
  int index = 0;    ///< It numbers the episodes of one door and seed.
  Episode episode;  ///< Without the clouds of its decisions.
};
std::string NameOf(const SimulatedEpisode& episode);  ///< "DOOR_seed7_0".

/// Lets the expert, or whoever `run_episode` lets act, open every door and shows progress. The
/// episodes come in the order of doors, seeds and indices; those whose turn came after a stop
/// request are left out.
///
/// @throws Error(kInvalidArgument) if a picture is there and is not to be replaced; else as
///     FindDoorSet(), LoadRobot() and SampleScene().
std::vector<SimulatedEpisode> SimulateDoors(const SimulationRun& run);

/// How a group of episodes ended.
struct OutcomeTally {
  int episodes = 0;
  int opened = 0;
  double low = 0;                       ///< Wilson's interval at 95 % of the share that opened.
  double high = 1;                      ///< Its upper end.
  std::map<std::string, int> outcomes;  ///< Episodes by the name of their outcome.
};

/// The tally of all episodes, "overall", and of each category; none where there are no episodes.
std::map<std::string, OutcomeTally> TallyOutcomes(std::span<const SimulatedEpisode> episodes);

/// {"schema": "doorforge.simulate", "success": {GROUP: {"rate", "low", "high", "episodes",
/// "outcomes"}}, "episodes": [{"door", "category", "mechanism", "seed", "episode", "outcome",
/// "detail", "peak_hinge_deg", "peak_handle_deg", "actions", "simulated_s", "state_sha256"}]}.
nlohmann::ordered_json SimulatedToJson(std::span<const SimulatedEpisode> episodes);

/// Says it for people: a line an episode with its outcome, then one a group of TallyOutcomes().
std::string SimulatedText(std::span<const SimulatedEpisode> episodes);

/// How many of them did not open the door.
std::size_t FailedAmong(std::span<const SimulatedEpisode> episodes);

}  // namespace doorforge
