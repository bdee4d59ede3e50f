// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"
#include "doorforge/core/progress.h"
#include "doorforge/core/record_id.h"
#include "doorforge/exporters/export_door.h"
#include "doorforge/mesh/work_budget.h"
#include "doorforge/validate/validate_door.h"

#include "verbs.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::vector<std::string> paths;
  std::vector<std::string> formats;
  std::string out;
  int threads = 0;
  bool overwrite = false;
  bool json = false;
};

Options Parse(int argc, char** argv) {
  Options options;
  CLI::App app("Writes doors for other simulators and viewers.", "doorforge export");
  app.add_option("DOOR", options.paths, "folders of doors, or folders that hold some")->required();
  app.add_option("--format,--to", options.formats,
                 "urdf, mjcf, sdf, glb, usda; several with commas")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->required()
      ->check(CLI::IsMember({"urdf", "mjcf", "sdf", "glb", "usda"}));
  app.add_option("--out", options.out, "each door goes to OUT/<id>")->required();
  app.add_option("--threads", options.threads, "0: all processors; no byte depends on it");
  app.add_flag("--overwrite", options.overwrite, "replace what is there already");
  app.add_flag("--json", options.json, "print one JSON document");
  app.footer(
      "example:\n"
      "  doorforge export --format mjcf,glb doors/mine --out exported");
  ParseVerb(app, argc, argv);
  return options;
}

struct Exported {
  std::string folder;
  std::string id;
  std::string problem;
};

std::vector<Exported> DoorsOf(const Options& options) {
  std::vector<Exported> doors;
  for (const std::string& path : options.paths) {
    for (const fs::path& folder : FindRecords(path)) {
      if (fs::exists(folder / "door.json")) doors.push_back({folder.string(), {}, {}});
    }
  }
  if (doors.empty())
    throw Error(ErrorCode::kMissing,
                "export: no door.json there; `doorforge compose` makes doors of parts");
  return doors;
}

void Export(const Options& options, const std::vector<DoorFormat>& formats, Exported& exported) {
  try {
    if (StopRequested() != 0) throw Error(ErrorCode::kIncomplete, "stopped before its turn");
    const DoorAsset door = ReadDoor(exported.folder);
    exported.id = door.id;
    WriteExportedDoor(door, formats, OutputBelow(options.out, door.id),
                      options.overwrite ? Existing::kReplace : Existing::kRefuse);
  } catch (const Error& error) {
    exported.problem = error.what();
  } catch (const std::exception&) {
    exported.problem = CurrentProblem(exported.folder);
  }
}

int Finish(const std::vector<Exported>& doors, const Options& options) {
  std::size_t failed = 0;
  auto list = nlohmann::ordered_json::array();
  for (const Exported& door : doors) {
    list.push_back({{"folder", door.folder},
                    {"id", door.id},
                    {"exported", door.problem.empty()},
                    {"message", door.problem}});
    if (door.problem.empty()) continue;
    ++failed;
    std::fprintf(stderr, "doorforge: %s: %s\n", door.folder.c_str(), door.problem.c_str());
  }
  if (options.json)
    std::cout << JsonText(
                     nlohmann::ordered_json{
                         {"schema", "doorforge.export"}, {"schema_version", 1}, {"doors", list}},
                     2)
              << '\n';
  else
    std::printf("%zu doors exported to %s\n", doors.size() - failed, options.out.c_str());
  if (const int signal = StopRequested()) return 128 + signal;
  return failed == 0 ? 0 : 1;
}

}  // namespace

int RunExportVerb(int argc, char** argv) {
  const Options options = Parse(argc, argv);
  std::vector<DoorFormat> formats;
  for (const std::string& name : options.formats) formats.push_back(*DoorFormatNamed(name));
  std::vector<Exported> doors = DoorsOf(options);
  RequireWritable(options.out);
  Progress progress("exporting", doors.size());
  ParallelFor(doors.size(), options.threads, [&](std::size_t i) {
    Export(options, formats, doors[i]);
    progress.Advance();
  });
  return Finish(doors, options);
}

}  // namespace doorforge
