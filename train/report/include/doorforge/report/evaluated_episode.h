// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/door_identity.h"
#include "doorforge/schemas/episode.h"
#include "doorforge/schemas/names.h"
#include "doorforge/schemas/scene.h"

namespace doorforge {

/// One row of a report: what became of one episode.
struct EvaluatedEpisode {
  std::string door_id;
  Category category = Category::kInterior;
  Mechanism mechanism = Mechanism::kLever;  ///< kNone: a door without a latch.
  std::string body;                         ///< Ids of the door's parts.
  std::string handle;
  std::uint64_t seed = 0;
  std::uint64_t episode = 0;  ///< Index among the episodes of this door and seed.
  EpisodeOutcome outcome = EpisodeOutcome::kDiverged;
  std::string detail;           ///< The numbers that explain the outcome, for people.
  int opening_actions = 0;      ///< Decisions that the evaluated policy took.
  double peak_hinge_rad = 0;    ///< Greatest angle of the door.
  double peak_handle_rad = 0;   ///< Greatest angle of the handle.
  double simulated_s = 0;       ///< Simulated time of the whole episode.
  int grasps = 1;               ///< So many times the hand took hold.
  bool handle_turned = false;   ///< The handle was held, turned and unlocked.
  double peak_force_n = 0;      ///< Greatest force between robot and door, see Episode.
  double peak_net_force_n = 0;  ///< Beyond the squeeze of the fingers, see Episode.
  std::string state_sha256;     ///< Hash of the final joint state: equal runs have equal hashes.
};

/// Drops clouds and actions, keeps what a report says about an episode on `door`.
EvaluatedEpisode RowOf(const Episode& episode, const DoorAsset& door);

/// The row of an episode that nobody ran, since its door can be read no more; its cause is
/// kDoorGone.
///
/// @param scene Its seed and episode are read.
EvaluatedEpisode RowOfGoneDoor(const DoorIdentity& door, const Scene& scene,
                               const std::string& reason);

/// The cause of an episode in which no point of the handle was in the grasper's view. Records know
/// it as kNotReached, with the reason in the detail.
inline constexpr std::string_view kNoGraspInView = "no_grasp_in_view";

/// The cause of an episode in which a policy had no action to give, see Fallible. Records know it
/// as kDiverged, with the reason in the detail.
inline constexpr std::string_view kNoAction = "policy_failed";

/// The cause of an episode whose door could be read no more. Records know it as kNotReached, with
/// the reason in the detail.
inline constexpr std::string_view kDoorGone = "door_gone";

/// Whether anything moved in the episodes with a cause, and would again, so that one can be shown.
bool CanBeShown(std::string_view cause);

/// What became of an episode, for statistics: kNoGraspInView, kNoAction, kDoorGone, else the name
/// of its outcome.
std::string_view CauseOf(const EvaluatedEpisode& episode);

/// Without what the door's identity says but the category.
nlohmann::ordered_json EvaluatedEpisodeToJson(const EvaluatedEpisode& episode);

/// The doors of a record by their ids.
using DoorsById = std::map<std::string, DoorIdentity>;

/// Throws Error(kFormat), also for a door that is not among `doors`; `path` names the record.
EvaluatedEpisode EvaluatedEpisodeFromJson(const nlohmann::ordered_json& json,
                                          const DoorsById& doors, const std::string& path);

}  // namespace doorforge
