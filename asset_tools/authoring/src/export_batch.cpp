// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/authoring/export_batch.h"

#include <algorithm>
#include <exception>
#include <optional>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/free_space.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/core/record_id.h"
#include "doorforge/core/temporary_folder.h"
#include "doorforge/mesh/work_budget.h"

namespace doorforge {
namespace {

/// What a run comes to.
struct Wanted {
  std::vector<DoorFormat> formats;
  bool thumbnails = false;
};

Wanted WantedOf(const ExportRun& run) {
  std::vector<std::string> names = run.formats;
  Wanted wanted;
  wanted.thumbnails = run.thumbnails;
  for (const std::string& name : run.profiles) {
    const ExportProfile* profile = ExportProfileNamed(name);
    Require(profile != nullptr, ErrorCode::kInvalidArgument, "export: no profile \"" + name + '"');
    names.emplace_back(profile->format);
    wanted.thumbnails = wanted.thumbnails || profile->thumbnail;
  }
  for (const std::string& name : names)
    Require(DoorFormatNamed(name) != nullptr, ErrorCode::kInvalidArgument,
            "export: no format \"" + name + '"');
  for (const DoorFormat& format : DoorFormats()) {
    if (std::find(names.begin(), names.end(), format.name) != names.end())
      wanted.formats.push_back(format);
  }
  Require(!names.empty(), ErrorCode::kInvalidArgument,
          "--format or --profile is required; see `doorforge export --help`");
  Require(!wanted.thumbnails || run.draw != nullptr, ErrorCode::kInvalidArgument,
          "--thumbnails: this build draws nothing, since it lacks sim/sensor; export by --format "
          "alone");
  return wanted;
}

void Export(const ExportRun& run, const Wanted& wanted, ExportedDoor& exported) {
  try {
    if (StopRequested() != 0) throw Error(ErrorCode::kIncomplete, "stopped before its turn");
    const DoorAsset door = ReadDoor(exported.folder);
    exported.id = door.id;
    ExportSettings settings = run.settings;
    if (wanted.thumbnails) settings.thumbnail_png = run.draw(exported.folder);
    WriteExportedDoor(door, wanted.formats, OutputBelow(run.out, door.id), run.existing, settings);
  } catch (const Error& error) {
    exported.problem = error.what();
  } catch (const std::exception&) {
    exported.problem = CurrentProblem(exported.folder);
  }
}

// What the files of a door take, by writing them where they are deleted again; nothing if it cannot
// be exported, which its own turn will say.
std::optional<double> BytesOfDoor(const std::filesystem::path& folder, const Wanted& wanted,
                                  const ExportSettings& settings) {
  try {
    const TemporaryFolder trial;
    WriteExportedDoor(ReadDoor(folder), wanted.formats, trial.path() / "door", Existing::kRefuse,
                      settings);
    return BytesBelow(trial.path());
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

// A few doors, evenly spread, tell what all of them take.
void RequireSpaceForDoors(std::span<const std::filesystem::path> folders, const ExportRun& run,
                          const Wanted& wanted) {
  constexpr std::size_t kTried = 4;
  constexpr std::size_t kMany = 2 * kTried;  // for fewer, trying takes longer than it is worth
  constexpr double kSurely = 0.8;            // what is not among the tried may be smaller
  if (folders.size() < kMany) return;
  double bytes = 0;
  int tried = 0;
  for (std::size_t i = 0; i < kTried; ++i) {
    const auto& folder = folders[i * folders.size() / kTried];
    const std::optional<double> one = BytesOfDoor(folder, wanted, run.settings);
    if (!one) continue;
    bytes += *one;
    ++tried;
  }
  if (tried == 0) return;
  const double needed = kSurely * bytes / tried * static_cast<double>(folders.size());
  RequireSpace(run.out, needed - BytesBelow(run.out), "make room, or choose another --out");
}

}  // namespace

std::vector<ExportedDoor> ExportDoors(std::span<const std::filesystem::path> folders,
                                      const ExportRun& run) {
  const Wanted wanted = WantedOf(run);
  RequireWritable(run.out);
  RequireSpaceForDoors(folders, run, wanted);
  std::vector<ExportedDoor> doors;
  for (const std::filesystem::path& folder : folders) doors.push_back({folder.string(), {}, {}});
  Progress progress("exporting", doors.size());
  ParallelFor(doors.size(), run.threads, [&](std::size_t i) {
    Export(run, wanted, doors[i]);
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
