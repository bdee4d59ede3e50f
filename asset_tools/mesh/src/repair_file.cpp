// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/repair_file.h"

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

}  // namespace doorforge
