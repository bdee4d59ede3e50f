// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The program that lets the expert, or policies by name, open doors.

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/cli/verb_table.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/environment_preset.h"
#include "doorforge/core/program.h"
#include "doorforge/registry/policy_episodes.h"
#include "doorforge/registry/policy_options.h"
#include "doorforge/robot_meshes/robot_meshes.h"
#include "doorforge/rollout/simulate_doors.h"

namespace doorforge {
namespace {

struct Options {
  SimulationRun run;
  PolicyWords policies;
  PolicySimulateConfig settings;
  ConfigSources config;
  bool json = false;
};

Options Parse(int argc, char** argv) {
  CLI::App app("Lets the expert, or policies, open doors in the physics and says what came of it.",
               "doorforge simulate");
  app.footer(
      "example:\n  doorforge compose --all --category interior --out doors\n"
      "  doorforge simulate --door doors --episodes 5");
  Options options;
  SimulationRun& run = options.run;
  std::string robot;
  app.add_option("--door", run.doors, "a door's folder, or a folder of them")->required();
  AddPolicyOptions(app, BuiltInPolicies(), options.policies);
  AddSeed(app, run.seed, "first seed");
  const auto add_count = [&](const char* name, int& count, const char* about) {
    app.add_option(name, count, about)->capture_default_str()->check(CLI::Range(1, 1000000));
  };
  add_count("--seeds", run.seeds, "number of seeds");
  add_count("--episodes", run.episodes, "episodes of each door in each seed");
  app.add_option("--robot", robot, "URDF of a robot; the built-in mobile Franka if left out")
      ->check(CLI::ExistingFile);
  app.add_option("--film", run.film, "folder for a PNG of each episode");
  AddOverwrite(app, run.overwrite, "replace pictures that are in --film");
  AddThreads(app, run.threads);
  AddEnvironment(app, options.config);
  AddConfig(app, options.config.file, "YAML file with settings");
  AddSettings(app, options.config.settings, "a.b=c overrides one setting");
  AddJson(app, options.json);
  ParseVerb(app, argc, argv);
  options.settings = LoadConfig<PolicySimulateConfig>(options.config);
  if (!robot.empty()) options.settings.scene.robot = robot;
  run.read_meshes = RobotMeshes();
  return options;
}

// 0 if all doors were opened.
int RunSimulateVerb(int argc, char** argv) {
  const Options options = Parse(argc, argv);
  const auto episodes = NamingConfig(options.config.Named(), [&] {
    return SimulateDoorsWith(options.policies, options.settings, options.run);
  });
  PrintAnswer(options.json, SimulatedToJson(episodes), SimulatedText(episodes));
  return ExitCodeOfBatch(FailedAmong(episodes));
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunOneVerb({"simulate", doorforge::RunSimulateVerb}, argc, argv);
}
