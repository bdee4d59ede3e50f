// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/repair_file.h"

#include <cstdio>
#include <new>

#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/mesh/import_mesh.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json RecordOf(const fs::path& input, const RepairConfig& config, const RepairReport& report) {
  Json record = ToJson(report);
  record["input"] = {{"path", input.string()}, {"sha256", Sha256OfFile(input)}};
  record["config"] = ToJson(config);
  record["config_sha256"] = Sha256Hex(JsonText(record["config"]));
  record["code_version"] = CodeVersion();
  return record;
}

RepairResult Repaired(const fs::path& input, const RepairConfig& config, double max_seconds) {
  const TriangleMesh mesh = MergedPieces(ImportMesh(input));
  const WorkBudget budget(input.string(), max_seconds);
  try {
    return RepairMesh(mesh, config);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::kInvalidConfig) throw;
    throw Error(error.code(), CurrentProblem(input.string()));
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::kFormat, CurrentProblem(input.string()));
  }
}

}  // namespace

RepairedFile RepairMeshFile(const fs::path& input, const RepairConfig& config, double max_seconds) {
  RepairedFile repaired;
  repaired.result = Repaired(input, config, max_seconds);
  repaired.record = RecordOf(input, config, repaired.result.report);
  return repaired;
}

std::string RepairText(const RepairReport& report) {
  std::string text(NameOf(report.outcome));
  if (!report.reason.empty()) text += " (" + report.reason + ")";
  for (const std::string& step : report.steps) text += "\n  " + step;
  text += "\n";
  if (report.outcome == RepairOutcome::kFailed) return text;
  const auto add = [&](const char* format, auto... values) {
    char line[160];
    std::snprintf(line, sizeof line, format, values...);
    text += line;
  };
  add("  volume %.6g m3, area %.6g m2, %d pieces%s\n", report.after.volume_m3, report.after.area_m2,
      report.after.components,
      report.self_intersects ? ", which cross each other or themselves" : "");
  const auto add_deviation = [&](const char* which, const SurfaceDeviation& deviation) {
    add("  %s: mean %.3f mm, largest %.3f mm\n", which, 1000 * deviation.mean_m,
        1000 * deviation.max_m);
  };
  add_deviation("output to input", report.output_to_input);
  add_deviation("visible input to output", report.visible_input_to_output);
  return text;
}

}  // namespace doorforge
