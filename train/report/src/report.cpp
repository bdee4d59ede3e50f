// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/report/report.h"

#include <algorithm>
#include <set>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/json_numbers.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;
using Episodes = std::span<const EvaluatedEpisode>;

Json RateToJson(const SuccessRate& rate) {
  return {{"rate", rate.rate},         {"low", rate.low},          {"high", rate.high},
          {"episodes", rate.episodes}, {"opened", rate.successes}, {"trials", rate.trials}};
}

Json SpreadToJson(const SeedSpread& spread) {
  return {{"mean", spread.mean},
          {"variance", spread.variance},
          {"seeds", spread.seeds},
          {"rates", spread.rates}};
}

Json AnglesToJson(const std::vector<AngleSuccess>& angles) {
  Json json = Json::array();
  for (const AngleSuccess& angle : angles) {
    json.push_back({{"angle_rad", angle.angle_rad},
                    {"rate", angle.success.rate},
                    {"low", angle.success.low},
                    {"high", angle.success.high}});
  }
  return json;
}

/// What the episodes of a group come to.
struct GroupSummary {
  std::string name;
  SuccessSummary summary;
};

std::vector<GroupSummary> SummariesOf(Episodes episodes) {
  std::vector<GroupSummary> summaries;
  for (const EpisodeGroup& group : GroupsOf(episodes))
    summaries.push_back({NameOf(group), Summarise(OfGroup(episodes, group))});
  return summaries;
}

// {"overall": value, "<category>": value, ...}
template <class ValueOfSummary>
Json ByGroup(const std::vector<GroupSummary>& groups, const ValueOfSummary& value) {
  Json json = Json::object();
  for (const GroupSummary& group : groups) json[group.name] = value(group.summary);
  return json;
}

Json ForcesToJson(const std::vector<ForceSuccess>& limits) {
  Json json = Json::array();
  for (const ForceSuccess& limit : limits) {
    Json row = RateToJson(limit.success);
    row["limit_n"] = limit.limit_n;
    json.push_back(std::move(row));
  }
  return json;
}

Json CausesToJson(Episodes episodes) {
  Json json = Json::object();
  for (const FailureCause& cause : CausesOf(episodes)) json[cause.name] = cause.episodes;
  return json;
}

void AddSuccess(Episodes episodes, Json& json) {
  const std::vector<GroupSummary> groups = SummariesOf(episodes);
  json["success"] = ByGroup(groups, [](const auto& s) { return RateToJson(s.opened); });
  json["handle_success"] =
      ByGroup(groups, [](const auto& s) { return RateToJson(s.handle_turned); });
  json["effort"] = ByGroup(groups, [](const auto& s) {
    return Json{
        {"median_opening_s", s.median_opening_s}, {"median_force_n", s.median_force_n},
        {"peak_force_n", s.peak_force_n},         {"median_net_force_n", s.median_net_force_n},
        {"p99_net_force_n", s.most_net_force_n},  {"peak_net_force_n", s.peak_net_force_n}};
  });
  json["over_seeds"] = ByGroup(groups, [](const auto& s) { return SpreadToJson(s.over_seeds); });
  json["over_angle"] = ByGroup(groups, [](const auto& s) { return AnglesToJson(s.over_angle); });
  json["within_force"] =
      ByGroup(groups, [](const auto& s) { return ForcesToJson(s.within_force); });
  json["causes"] = CausesToJson(episodes);
}

Json DoorToJson(const DoorIdentity& door) {
  return {{"id", door.id},
          {"category", NameOf(door.category)},
          {"mechanism", NameOf(door.mechanism)},
          {"body", IdentityToJson(door.body)},
          {"handle", IdentityToJson(door.handle)},
          {"sha256", door.sha256},
          {"license", door.license}};
}

DoorIdentity DoorFromJson(const Json& json, const std::string& path) {
  DoorIdentity door;
  door.id = ValueOf<std::string>(json, "id", path);
  const auto category = CategoryNamed(ValueOf<std::string>(json, "category", path));
  const auto mechanism = MechanismNamed(ValueOf<std::string>(json, "mechanism", path));
  if (!category || !mechanism)
    throw Error(ErrorCode::kFormat, path + ": unknown category or mechanism of door " + door.id);
  door.category = *category;
  door.mechanism = *mechanism;
  door.body = IdentityFromJson(MemberOf(json, "body", path), path + ".body");
  door.handle = IdentityFromJson(MemberOf(json, "handle", path), path + ".handle");
  door.sha256 = ValueOf<std::string>(json, "sha256", path);
  door.license = ValueOf<std::string>(json, "license", path);
  return door;
}

Json LossToJson(const LossCurve& loss) {
  return {{"name", loss.name},
          {"unit", loss.unit},
          {"epoch", NumbersToJson(loss.epoch)},
          {"train", NumbersToJson(loss.train)},
          {"validation", NumbersToJson(loss.validation)}};
}

LossCurve LossFromJson(const Json& json, const std::string& path) {
  LossCurve loss;
  loss.name = ValueOf<std::string>(json, "name", path);
  loss.unit = ValueOf<std::string>(json, "unit", path);
  loss.epoch = NumbersFromJson(MemberOf(json, "epoch", path), path + ".epoch");
  loss.train = NumbersFromJson(MemberOf(json, "train", path), path + ".train");
  loss.validation = NumbersFromJson(MemberOf(json, "validation", path), path + ".validation");
  if (loss.train.size() != loss.epoch.size() || loss.validation.size() != loss.epoch.size())
    throw Error(ErrorCode::kFormat, path + ": epoch, train and validation differ in length");
  return loss;
}

Json ProvenanceToJson(const ReportProvenance& provenance) {
  Json json = {{"policy", provenance.policy},
               {"policy_sha256", provenance.policy_sha256},
               {"dataset_sha256", provenance.dataset_sha256},
               {"code_version", provenance.code_version},
               {"command", provenance.command},
               {"config_sha256", Sha256Hex(JsonText(provenance.config))},
               {"config", provenance.config}};
  if (!provenance.handler_sha256.empty()) json["handler_sha256"] = provenance.handler_sha256;
  if (!provenance.grasper_sha256.empty()) json["grasper_sha256"] = provenance.grasper_sha256;
  if (!provenance.finder_sha256.empty()) json["finder_sha256"] = provenance.finder_sha256;
  if (!provenance.privileges.empty()) json["privileges"] = provenance.privileges;
  return json;
}

std::vector<std::string> PhrasesFromJson(const Json& json, const std::string& path) {
  const bool are_phrases = json.is_array() && std::ranges::all_of(json, [](const Json& item) {
                             return item.is_string();
                           });
  if (!are_phrases) throw Error(ErrorCode::kFormat, path + ": expected an array of texts");
  return json.get<std::vector<std::string>>();
}

ReportProvenance ProvenanceFromJson(const Json& json, const std::string& path) {
  ReportProvenance provenance;
  provenance.policy = ValueOf<std::string>(json, "policy", path);
  provenance.policy_sha256 = ValueOf<std::string>(json, "policy_sha256", path);
  provenance.dataset_sha256 = ValueOf<std::string>(json, "dataset_sha256", path);
  if (json.contains("handler_sha256"))
    provenance.handler_sha256 = ValueOf<std::string>(json, "handler_sha256", path);
  if (json.contains("grasper_sha256"))
    provenance.grasper_sha256 = ValueOf<std::string>(json, "grasper_sha256", path);
  if (json.contains("finder_sha256"))
    provenance.finder_sha256 = ValueOf<std::string>(json, "finder_sha256", path);
  if (json.contains("privileges"))
    provenance.privileges = PhrasesFromJson(json["privileges"], path + ".privileges");
  provenance.code_version = ValueOf<std::string>(json, "code_version", path);
  provenance.command = ValueOf<std::string>(json, "command", path);
  provenance.config = MemberOf(json, "config", path);
  return provenance;
}

template <class T, class Codec>
Json ArrayToJson(const std::vector<T>& values, const Codec& to_json) {
  Json json = Json::array();
  for (const T& value : values) json.push_back(to_json(value));
  return json;
}

template <class Codec>
auto ArrayFromJson(const Json& json, const std::string& path, const Codec& from_json) {
  if (!json.is_array()) throw Error(ErrorCode::kFormat, path + ": expected an array");
  std::vector<decltype(from_json(json, path))> values;
  for (std::size_t i = 0; i < json.size(); ++i)
    values.push_back(from_json(json[i], path + "[" + std::to_string(i) + "]"));
  return values;
}

}  // namespace

bool IsTrained(std::string_view actor) {
  constexpr std::size_t kDigits = 64;
  return actor.size() == kDigits &&
         actor.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool DidAll(const ReportProvenance& provenance) {
  return IsTrained(provenance.policy_sha256) &&
         provenance.handler_sha256 == provenance.policy_sha256 &&
         provenance.grasper_sha256 == provenance.policy_sha256;
}

bool IsSwitchPredicted(const ReportProvenance& provenance) {
  return !DidAll(provenance) && IsTrained(provenance.handler_sha256) &&
         provenance.config.is_object() &&
         provenance.config.value("switch", "predicted") == "predicted";
}

std::vector<std::string> SeenDoors(std::span<const DoorIdentity> doors,
                                   const SeenParts& trained_on) {
  std::vector<std::string> seen;
  for (const DoorIdentity& door : doors) {
    if (trained_on.Holds(door.body, door.handle)) seen.push_back(door.id);
  }
  return seen;
}

Json ReportToJson(const EvaluationReport& report) {
  Json json{{"schema", "doorforge.report"}, {"schema_version", kReportSchemaVersion}};
  AddSuccess(report.episodes, json);
  if (!report.reference.empty()) {
    json["expert"] = Json::object();
    AddSuccess(report.reference, json["expert"]);
  }
  json["provenance"] = ProvenanceToJson(report.provenance);
  json["doors"] = ArrayToJson(report.doors, DoorToJson);
  json["trained_on"] = SeenPartsToJson(report.trained_on);
  json["training_doors"] = ArrayToJson(report.training_doors, DoorToJson);
  json["losses"] = ArrayToJson(report.losses, LossToJson);
  json["episodes"] = ArrayToJson(report.episodes, EvaluatedEpisodeToJson);
  json["expert_episodes"] = ArrayToJson(report.reference, EvaluatedEpisodeToJson);
  return json;
}

EvaluationReport ReportFromJson(const Json& json, const std::string& path) {
  RequireSchema(json, "doorforge.report", kReportSchemaVersion, path);
  const auto read = [&](const char* key, const auto& from_json) {
    return ArrayFromJson(MemberOf(json, key, path), path + "." + key, from_json);
  };
  EvaluationReport report;
  report.provenance = ProvenanceFromJson(MemberOf(json, "provenance", path), path + ".provenance");
  report.doors = read("doors", DoorFromJson);
  report.trained_on = SeenPartsFromJson(MemberOf(json, "trained_on", path), path + ".trained_on");
  report.training_doors = read("training_doors", DoorFromJson);
  report.losses = read("losses", LossFromJson);
  DoorsById doors;
  for (const DoorIdentity& door : report.doors) doors.emplace(door.id, door);
  const auto row = [&](const Json& episode, const std::string& where) {
    return EvaluatedEpisodeFromJson(episode, doors, where);
  };
  report.episodes = read("episodes", row);
  report.reference = read("expert_episodes", row);
  return report;
}

}  // namespace doorforge
