// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/authoring/export_batch.h"

#include <exception>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/core/record_id.h"
#include "doorforge/mesh/work_budget.h"

namespace doorforge {
namespace {

void Export(const ExportRun& run, ExportedDoor& exported) {
  try {
    if (StopRequested() != 0) throw Error(ErrorCode::kIncomplete, "stopped before its turn");
    const DoorAsset door = ReadDoor(exported.folder);
    exported.id = door.id;
    WriteExportedDoor(door, run.formats, OutputBelow(run.out, door.id), run.existing, run.settings);
  } catch (const Error& error) {
    exported.problem = error.what();
  } catch (const std::exception&) {
    exported.problem = CurrentProblem(exported.folder);
  }
}

}  // namespace

std::vector<ExportedDoor> ExportDoors(std::span<const std::filesystem::path> folders,
                                      const ExportRun& run) {
  RequireWritable(run.out);
  std::vector<ExportedDoor> doors;
  for (const std::filesystem::path& folder : folders) doors.push_back({folder.string(), {}, {}});
  Progress progress("exporting", doors.size());
  ParallelFor(doors.size(), run.threads, [&](std::size_t i) {
    Export(run, doors[i]);
    progress.Advance();
  });
  return doors;
}

nlohmann::ordered_json ExportedToJson(std::span<const ExportedDoor> doors) {
  auto list = nlohmann::ordered_json::array();
  for (const ExportedDoor& door : doors)
    list.push_back({{"folder", door.folder},
                    {"id", door.id},
                    {"exported", door.problem.empty()},
                    {"message", door.problem}});
  return {{"schema", "doorforge.export"}, {"schema_version", 1}, {"doors", list}};
}

std::vector<std::string> ProblemsOf(std::span<const ExportedDoor> doors) {
  std::vector<std::string> problems;
  for (const ExportedDoor& door : doors) {
    if (!door.problem.empty()) problems.push_back(door.folder + ": " + door.problem);
  }
  return problems;
}

}  // namespace doorforge
