// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/episode.h"

#include <array>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"

namespace doorforge {
namespace {

constexpr int kEpisodeSchemaVersion = 1;
constexpr std::array<std::string_view, kEpisodeOutcomeCount> kOutcomes = {
    "opened",    "not_reached", "grasp_missed", "handle_slipped", "handle_stuck",
    "grip_lost", "door_stuck",  "joint_limit",  "collision",      "diverged"};
constexpr std::array<std::string_view, 3> kStages = {"open", "handle", "grasp"};

}  // namespace

std::string_view NameOf(EpisodeOutcome outcome) {
  return kOutcomes.at(static_cast<std::size_t>(outcome));
}

std::optional<EpisodeOutcome> EpisodeOutcomeNamed(std::string_view name) {
  for (std::size_t i = 0; i < kOutcomes.size(); ++i) {
    if (kOutcomes[i] == name) return static_cast<EpisodeOutcome>(i);
  }
  return std::nullopt;
}

std::string_view NameOf(Stage stage) { return kStages.at(static_cast<std::size_t>(stage)); }

std::optional<Stage> StageNamed(std::string_view name) {
  for (std::size_t i = 0; i < kStages.size(); ++i) {
    if (kStages[i] == name) return static_cast<Stage>(i);
  }
  return std::nullopt;
}

nlohmann::ordered_json EpisodeMetaToJson(const Episode& episode) {
  nlohmann::ordered_json times = nlohmann::ordered_json::array();
  for (const Decision& decision : episode.decisions) times.push_back(decision.time_s);
  return {{"schema", "doorforge.episode"},
          {"schema_version", kEpisodeSchemaVersion},
          {"outcome", NameOf(episode.outcome)},
          {"success", episode.outcome == EpisodeOutcome::kOpened},
          {"detail", episode.detail},
          {"peak_hinge_rad", episode.peak_hinge_rad},
          {"peak_handle_rad", episode.peak_handle_rad},
          {"simulated_s", episode.simulated_s},
          {"state_sha256", episode.state_sha256},
          {"decision_time_s", times},
          {"scene", SceneToJson(episode.scene)}};
}

Episode EpisodeFromMeta(const nlohmann::ordered_json& json, const std::string& path) {
  RequireSchema(json, "doorforge.episode", kEpisodeSchemaVersion, path);
  Episode episode;
  const auto outcome = ValueOf<std::string>(json, "outcome", path);
  if (!EpisodeOutcomeNamed(outcome))
    throw Error(ErrorCode::kFormat, path + ".outcome: unknown name \"" + outcome + '"');
  episode.outcome = *EpisodeOutcomeNamed(outcome);
  episode.detail = ValueOf<std::string>(json, "detail", path);
  episode.peak_hinge_rad = ValueOf<double>(json, "peak_hinge_rad", path);
  episode.peak_handle_rad = ValueOf<double>(json, "peak_handle_rad", path);
  episode.simulated_s = ValueOf<double>(json, "simulated_s", path);
  episode.state_sha256 = ValueOf<std::string>(json, "state_sha256", path);
  episode.scene = SceneFromJson(MemberOf(json, "scene", path), path + ".scene");
  for (const auto& time : MemberOf(json, "decision_time_s", path)) {
    if (!time.is_number()) throw Error(ErrorCode::kFormat, path + ".decision_time_s: wrong type");
    episode.decisions.emplace_back().time_s = time.get<double>();
  }
  return episode;
}

}  // namespace doorforge
