// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// A simulated episode as the files that `doorforge act` reads.

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/cli/verb_table.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/output_file.h"
#include "doorforge/deploy/record_sight.h"
#include "doorforge/schemas/door_set.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct Options {
  SightRequest request;
  std::string door;
  std::string out;
  std::string config;
  std::vector<std::string> settings;
  bool overwrite = false;
};

Options Parse(int argc, char** argv) {
  Options options;
  CLI::App app(
      "What a robot's camera sees of a door in the simulator, as files for `doorforge act`.",
      "doorforge sight");
  app.add_option("--door", options.door, "a door's folder")->required();
  app.add_option("--out", options.out, "folder for the files")->required();
  app.add_option("--seed", options.request.seed, "decides where door and robot stand")
      ->capture_default_str();
  app.add_option("--episode", options.request.episode, "number of the episode in this seed")
      ->capture_default_str();
  app.add_flag("--all", options.request.all_decisions,
               "every decision of turning and opening, and `lines`, which `doorforge act --stream` "
               "reads; not the first of each stage alone");
  app.add_flag("--overwrite", options.overwrite, "replace such files in --out");
  app.add_option("--config", options.config, "YAML file with the settings of the scene")
      ->check(CLI::ExistingFile);
  AddSettings(app, options.settings, "a.b=c overrides one setting, e.g. camera.width=640");
  app.footer(
      "Writes grasp/, handle/ and open/ with depth.png and camera.yaml, a mask of the handle or "
      "the\nrobot's state.\n\nexample:\n"
      "  doorforge compose --body interior_flush_01 --handle interior_lever_tube_01 --out d\n"
      "  doorforge sight --door d --out sight\n"
      "  doorforge act --depth sight/open/depth.png --camera sight/open/camera.yaml \\\n"
      "      --state sight/open/state.yaml --opener data/policies/opener --picture answer.png");
  ParseVerb(app, argc, argv);
  return options;
}

int Record(Options options) {
  options.request.scene = LoadConfig<SceneConfig>(options.config, options.settings);
  const std::vector<FoundDoor> doors = FindDoorSet({.folders = {options.door}}, 1).doors;
  Require(doors.size() == 1, ErrorCode::kInvalidArgument,
          options.door + ": holds " + std::to_string(doors.size()) +
              " doors, and the files are of one; name the folder of one of them");
  const fs::path out = options.out;
  RequireNoFile(out / "grasp" / "depth.png", options.overwrite);
  DoorCache shelf(doors);
  const RecordedSight recorded = RecordSight(shelf.Take(0), options.request, out);
  std::printf("%s: a look at the closed door, %d of turning the handle, %d of opening\n",
              out.c_str(), recorded.handle_decisions, recorded.open_decisions);
  return 0;
}

int RunSightVerb(int argc, char** argv) {
  const Options options = Parse(argc, argv);
  return NamingConfig(options.config, [&] { return Record(options); });
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunOneVerb({"sight", doorforge::RunSightVerb}, argc, argv);
}
