// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/mesh/repair_mesh.h"

namespace doorforge {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "doorforge.repair_report";
constexpr int kSchemaVersion = 1;

constexpr std::array kOutcomes{RepairOutcome::kAlreadyClosed, RepairOutcome::kRepaired,
                               RepairOutcome::kWrapped, RepairOutcome::kFailed};

Json ToJson(const MeshTopology& topology) {
  Json json{{"boundary_edges", topology.boundary_edges},
            {"non_manifold_edges", topology.non_manifold_edges},
            {"inconsistent_edges", topology.inconsistent_edges},
            {"non_manifold_vertices", topology.non_manifold_vertices},
            {"degenerate_triangles", topology.degenerate_triangles},
            {"components", topology.components},
            {"volume_m3", topology.volume_m3},
            {"area_m2", topology.area_m2}};
  if (!topology.bounds.isEmpty()) {
    json["min_m"] = Vector3ToJson(topology.bounds.min());
    json["max_m"] = Vector3ToJson(topology.bounds.max());
  }
  return json;
}

MeshTopology TopologyFromJson(const Json& json, const std::string& path) {
  MeshTopology topology;
  topology.boundary_edges = ValueOf<int>(json, "boundary_edges", path);
  topology.non_manifold_edges = ValueOf<int>(json, "non_manifold_edges", path);
  topology.inconsistent_edges = ValueOf<int>(json, "inconsistent_edges", path);
  topology.non_manifold_vertices = ValueOf<int>(json, "non_manifold_vertices", path);
  topology.degenerate_triangles = ValueOf<int>(json, "degenerate_triangles", path);
  topology.components = ValueOf<int>(json, "components", path);
  topology.volume_m3 = ValueOf<double>(json, "volume_m3", path);
  topology.area_m2 = ValueOf<double>(json, "area_m2", path);
  if (json.contains("min_m")) {
    topology.bounds.min() = Vector3FromJson(MemberOf(json, "min_m", path), path + ".min_m");
    topology.bounds.max() = Vector3FromJson(MemberOf(json, "max_m", path), path + ".max_m");
  }
  return topology;
}

Json ToJson(const SurfaceDeviation& deviation) {
  return {{"mean_m", deviation.mean_m}, {"max_m", deviation.max_m}, {"samples", deviation.samples}};
}

SurfaceDeviation DeviationFromJson(const Json& json, const std::string& path) {
  return {ValueOf<double>(json, "mean_m", path), ValueOf<double>(json, "max_m", path),
          ValueOf<int>(json, "samples", path)};
}

RepairOutcome OutcomeOf(const std::string& name, const std::string& path) {
  for (const RepairOutcome outcome : kOutcomes) {
    if (NameOf(outcome) == name) return outcome;
  }
  throw Error(ErrorCode::kFormat, path + ".outcome: \"" + name +
                                      "\", allowed already_closed, repaired, wrapped, failed");
}

std::vector<std::string> StepsFromJson(const Json& json, const std::string& path) {
  std::vector<std::string> steps;
  if (!json.is_array()) throw Error(ErrorCode::kFormat, path + ": expected an array");
  for (const Json& step : json) {
    if (!step.is_string()) throw Error(ErrorCode::kFormat, path + ": expected strings");
    steps.push_back(step.get<std::string>());
  }
  return steps;
}

}  // namespace

std::string_view NameOf(RepairOutcome outcome) {
  switch (outcome) {
    case RepairOutcome::kAlreadyClosed:
      return "already_closed";
    case RepairOutcome::kRepaired:
      return "repaired";
    case RepairOutcome::kWrapped:
      return "wrapped";
    case RepairOutcome::kFailed:
      return "failed";
  }
  return "";
}

Json ToJson(const RepairReport& report) {
  return {{"schema", kSchema},
          {"schema_version", kSchemaVersion},
          {"outcome", NameOf(report.outcome)},
          {"reason", report.reason},
          {"steps", report.steps},
          {"before", ToJson(report.before)},
          {"after", ToJson(report.after)},
          {"holes_filled", report.holes_filled},
          {"components_kept", report.components_kept},
          {"components_dropped", report.components_dropped},
          {"sheets_thickened", report.sheets_thickened},
          {"components_united", report.components_united},
          {"self_intersects", report.self_intersects},
          {"output_to_input", ToJson(report.output_to_input)},
          {"visible_input_to_output", ToJson(report.visible_input_to_output)}};
}

RepairReport RepairReportFromJson(const Json& json, const std::string& path) {
  RequireSchema(json, kSchema, kSchemaVersion, path);
  RepairReport report;
  report.outcome = OutcomeOf(ValueOf<std::string>(json, "outcome", path), path);
  report.reason = ValueOf<std::string>(json, "reason", path);
  report.steps = StepsFromJson(MemberOf(json, "steps", path), path + ".steps");
  report.before = TopologyFromJson(MemberOf(json, "before", path), path + ".before");
  report.after = TopologyFromJson(MemberOf(json, "after", path), path + ".after");
  report.holes_filled = ValueOf<int>(json, "holes_filled", path);
  report.components_kept = ValueOf<int>(json, "components_kept", path);
  report.components_dropped = ValueOf<int>(json, "components_dropped", path);
  report.sheets_thickened = ValueOf<int>(json, "sheets_thickened", path);
  report.components_united = ValueOf<int>(json, "components_united", path);
  report.self_intersects = ValueOf<bool>(json, "self_intersects", path);
  report.output_to_input =
      DeviationFromJson(MemberOf(json, "output_to_input", path), path + ".output_to_input");
  report.visible_input_to_output = DeviationFromJson(
      MemberOf(json, "visible_input_to_output", path), path + ".visible_input_to_output");
  return report;
}

}  // namespace doorforge
