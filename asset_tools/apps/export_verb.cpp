// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "doorforge/authoring/export_batch.h"
#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/schemas/find_doors.h"

#ifdef DOORFORGE_WITH_PREVIEW
#include "doorforge/preview/draw_records.h"
#endif

#include "verbs.h"

namespace doorforge {
namespace {

struct ExportOptions {
  std::vector<std::filesystem::path> paths;
  ExportRun run;
  bool json = false;
};

ExportOptions ParseExport(int argc, char** argv) {
  ExportOptions options;
  CLI::App app("Writes doors for other simulators and viewers.", "doorforge export");
  app.add_option("DOOR", options.paths, "folders of doors, or folders that hold some")->required();
  app.add_option("--format,--to", options.run.formats, "several with commas")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(DoorFormatNames()));
  app.add_option("--profile", options.run.profiles, "mujoco, isaac, gazebo, sapien: what it wants")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_flag("--thumbnails", options.run.thumbnails, "a picture beside the files of each door");
  app.add_option("--out", options.run.out, "each door goes to OUT/<id>")->required();
  AddChoice(app, "--latch", options.run.settings.latch,
            "bolt: bodies that hold; data: the law's numbers alone");
  AddThreads(app, options.run.threads, "0: all processors; no byte depends on it");
  AddOverwrite(app, options.run.existing, "replace what is there already");
  AddJson(app, options.json);
  app.footer(
      "example:\n"
      "  doorforge export --format mjcf,glb doors/mine --out exported");
  ParseVerb(app, argc, argv);
  return options;
}

}  // namespace

int RunExportVerb(int argc, char** argv) {
  ExportOptions options = ParseExport(argc, argv);
#ifdef DOORFORGE_WITH_PREVIEW
  options.run.draw = DrawnThumbnail;
#endif
  const auto found = FindDoors(options.paths);
  const auto doors = ExportDoors(std::vector(found.begin(), found.end()), options.run);
  const std::vector<std::string> problems = ProblemsOf(doors);
  return AnswerOfBatch(problems, options.json, ExportedToJson(doors),
                       std::to_string(doors.size() - problems.size()) + " doors exported to " +
                           options.run.out.string() + "\n");
}

}  // namespace doorforge
