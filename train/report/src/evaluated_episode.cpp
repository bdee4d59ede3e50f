// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/report/evaluated_episode.h"

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/fallible.h"

namespace doorforge {
namespace {

const std::string kGoneDoor = "the door is gone: ";

EpisodeOutcome OutcomeOf(const std::string& name, const std::string& path) {
  if (const auto outcome = EpisodeOutcomeNamed(name)) return *outcome;
  throw Error(ErrorCode::kFormat, path + ".outcome: unknown name \"" + name + '"');
}

Category CategoryOf(const std::string& name, const std::string& path) {
  if (const auto category = CategoryNamed(name)) return *category;
  throw Error(ErrorCode::kFormat, path + ".category: unknown name \"" + name + '"');
}

}  // namespace

EvaluatedEpisode RowOf(const Episode& episode, const DoorAsset& door) {
  return {.door_id = episode.scene.door_id,
          .category = door.category,
          .mechanism = door.mechanism,
          .body = door.body.id,
          .handle = door.handle.id,
          .seed = episode.scene.seed,
          .episode = episode.scene.episode,
          .outcome = episode.outcome,
          .detail = episode.detail,
          .opening_actions = static_cast<int>(episode.decisions.size()),
          .peak_hinge_rad = episode.peak_hinge_rad,
          .peak_handle_rad = episode.peak_handle_rad,
          .simulated_s = episode.simulated_s,
          .grasps = episode.grasps,
          .handle_turned = episode.handle_turned,
          .peak_force_n = episode.peak_force_n,
          .peak_net_force_n = episode.peak_net_force_n,
          .state_sha256 = episode.state_sha256};
}

EvaluatedEpisode RowOfGoneDoor(const DoorIdentity& door, const Scene& scene,
                               const std::string& reason) {
  EvaluatedEpisode row;
  row.door_id = door.id;
  row.category = door.category;
  row.mechanism = door.mechanism;
  row.body = door.body.id;
  row.handle = door.handle.id;
  row.seed = scene.seed;
  row.episode = scene.episode;
  row.outcome = EpisodeOutcome::kNotReached;
  row.detail = kGoneDoor + reason;
  row.grasps = 0;
  return row;
}

bool CanBeShown(std::string_view cause) {
  return cause != kNoGraspInView && cause != kNoAction && cause != kDoorGone;
}

std::string_view CauseOf(const EvaluatedEpisode& episode) {
  const bool unseen =
      episode.outcome == EpisodeOutcome::kNotReached &&
      episode.detail.find("no point to take hold of is in view") != std::string::npos;
  if (unseen) return kNoGraspInView;
  const bool gone =
      episode.outcome == EpisodeOutcome::kNotReached && episode.detail.starts_with(kGoneDoor);
  if (gone) return kDoorGone;
  const bool failed =
      episode.outcome == EpisodeOutcome::kDiverged && episode.detail.starts_with(kPolicyFailed);
  return failed ? kNoAction : NameOf(episode.outcome);
}

nlohmann::ordered_json EvaluatedEpisodeToJson(const EvaluatedEpisode& episode) {
  return {{"door_id", episode.door_id},
          {"category", NameOf(episode.category)},
          {"seed", episode.seed},
          {"episode", episode.episode},
          {"outcome", NameOf(episode.outcome)},
          {"detail", episode.detail},
          {"opening_actions", episode.opening_actions},
          {"peak_hinge_rad", episode.peak_hinge_rad},
          {"peak_handle_rad", episode.peak_handle_rad},
          {"simulated_s", episode.simulated_s},
          {"grasps", episode.grasps},
          {"handle_done", episode.handle_turned},
          {"peak_force_n", episode.peak_force_n},
          {"peak_net_force_n", episode.peak_net_force_n},
          {"state_sha256", episode.state_sha256}};
}

EvaluatedEpisode EvaluatedEpisodeFromJson(const nlohmann::ordered_json& json,
                                          const DoorsById& doors, const std::string& path) {
  const auto id = ValueOf<std::string>(json, "door_id", path);
  const auto door = doors.find(id);
  if (door == doors.end())
    throw Error(ErrorCode::kFormat, path + ".door_id: \"" + id + "\" is none of the doors");
  return {.door_id = id,
          .category = CategoryOf(ValueOf<std::string>(json, "category", path), path),
          .mechanism = door->second.mechanism,
          .body = door->second.body.id,
          .handle = door->second.handle.id,
          .seed = ValueOf<std::uint64_t>(json, "seed", path),
          .episode = ValueOf<std::uint64_t>(json, "episode", path),
          .outcome = OutcomeOf(ValueOf<std::string>(json, "outcome", path), path),
          .detail = ValueOf<std::string>(json, "detail", path),
          .opening_actions = ValueOf<int>(json, "opening_actions", path),
          .peak_hinge_rad = ValueOf<double>(json, "peak_hinge_rad", path),
          .peak_handle_rad = ValueOf<double>(json, "peak_handle_rad", path),
          .simulated_s = ValueOf<double>(json, "simulated_s", path),
          .grasps = json.contains("grasps")  // earlier builds had none
                        ? ValueOf<int>(json, "grasps", path)
                        : 1,
          .handle_turned = ValueOf<bool>(json, "handle_done", path),
          .peak_force_n = ValueOf<double>(json, "peak_force_n", path),
          .peak_net_force_n = json.contains("peak_net_force_n")  // earlier builds had none
                                  ? ValueOf<double>(json, "peak_net_force_n", path)
                                  : 0,
          .state_sha256 = ValueOf<std::string>(json, "state_sha256", path)};
}

}  // namespace doorforge
