// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/conformance/conformance.h"
#include "doorforge/core/error.h"
#include "doorforge/schemas/find_doors.h"

#include "verbs.h"

namespace doorforge {
namespace {

struct ConformanceOptions {
  std::vector<std::filesystem::path> paths;
  ConformanceRun run;
  ConformanceFormat format = ConformanceFormat::kText;
};

ConformanceOptions ParseConformance(int argc, char** argv) {
  ConformanceOptions options;
  options.run.clients = ConformanceClientNames();
  CLI::App app("Exports doors and has physics engines hold and open them.",
               "doorforge conformance");
  app.add_option("DOOR", options.paths, "folders of doors, or folders that hold some")->required();
  app.add_option("--clients", options.run.clients, "several with commas; all if left out")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(ConformanceClientNames()));
  app.add_option("--exports", options.run.formats, "formats to judge; all that a client reads")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"urdf", "mjcf", "sdf", "usda"}));
  app.add_option("--python", options.run.python, "interpreter that has the engines (python3)");
  AddChoice(app, "--latch", options.run.settings.latch, "as of `doorforge export`");
  app.add_option("--out", options.run.out, "folder that holds the exports afterwards")->required();
  AddChoice(app, "--format", options.format, "of the table");
  app.footer(
      "example:\n"
      "  doorforge conformance doors/mine --clients mujoco,pybullet --python venv/bin/python --out "
      "judged");
  ParseVerb(app, argc, argv);
  return options;
}

}  // namespace

int RunConformanceVerb(int argc, char** argv) {
  const ConformanceOptions options = ParseConformance(argc, argv);
  const auto found = FindDoors(options.paths);
  const std::vector<std::filesystem::path> doors(found.begin(), found.end());
  const ConformanceReport report = RunConformance(doors, options.run);
  PrintText(DocumentOf(report, options.format));
  if (report.rows.empty()) return ExitCodeOf(ErrorCode::kMissing);
  const auto failed = std::ranges::count(report.rows, false, &ConformanceRow::passed);
  return ExitCodeOfBatch(static_cast<std::size_t>(failed));
}

}  // namespace doorforge
