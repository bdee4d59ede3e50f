// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/program.h"

#include "simulate_verb.h"

namespace doorforge {
namespace {

int Main(int argc, char** argv) {
  // the front program passes its verb on
  if (argc > 1 && std::string(argv[1]) == "simulate") {
    --argc;
    ++argv;
  }
  CLI::App app("Lets the rule-based expert open doors in the physics and says what came of it.");
  app.name("doorforge simulate");
  app.footer(
      "example:\n  doorforge compose --all --category interior --out doors\n"
      "  doorforge simulate --door doors --episodes 5");
  SimulateOptions options;
  std::string config;
  std::string robot;
  std::vector<std::string> settings;
  app.add_option("--door", options.doors, "a door's folder, or a folder of them")->required();
  app.add_option("--seed", options.seed, "first seed")->capture_default_str();
  app.add_option("--seeds", options.seeds, "number of seeds")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app.add_option("--episodes", options.episodes, "episodes of each door in each seed")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app.add_option("--robot", robot, "URDF of a robot; the built-in mobile Franka if left out")
      ->check(CLI::ExistingFile);
  app.add_option("--film", options.film, "folder for a PNG of each episode");
  app.add_flag("--overwrite", options.overwrite, "replace pictures that are in --film");
  app.add_option("--threads", options.threads, "0: all processors")->check(CLI::Range(0, 4096));
  app.add_option("--config", config, "YAML file with the settings of scene and expert");
  AddSettings(app, settings, "a.b=c overrides one setting");
  app.add_flag("--json", options.json, "print one JSON document");
  ParseVerb(app, argc, argv);
  options.config = LoadConfig<SimulateConfig>(config, settings);
  if (!robot.empty()) options.config.scene.robot = robot;
  return NamingConfig(config, [&] { return Simulate(options); });
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] { return doorforge::Main(argc, argv); });
}
