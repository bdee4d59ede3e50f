// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The front program: `doorforge VERB ...` runs the program of the room that owns the verb, so that
// authoring an asset never waits for the training libraries to load.

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "doorforge/cli/command_line.h"
#include "doorforge/cli/verb_table.h"
#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"
#include "doorforge/core/program.h"

#include "verbs.h"

namespace doorforge {
namespace {

struct FrontVerb {
  const char* name;
  const char* program;  // empty: the front program itself
  const char* does;
};

constexpr const char* kAbout = "door assets and door-opening data for robot learning";
constexpr const char* kExample = "example:\n  doorforge quickstart --out run/quickstart";

constexpr std::array kVerbs = {
    FrontVerb{"quickstart", "", "the whole chain at small size, ends in report.html"},
    FrontVerb{"pipeline", "", "collect, train and evaluate all stages, step by step"},
    FrontVerb{"catalog", "doorforge-assets", "list, show and build the embedded door parts"},
    FrontVerb{"import", "doorforge-assets", "foreign door objects -> parts"},
    FrontVerb{"repair", "doorforge-assets", "any mesh -> a closed mesh with a measured report"},
    FrontVerb{"compose", "doorforge-assets",
              "a body and a handle -> a door (door.json, URDF, meshes)"},
    FrontVerb{"validate", "doorforge-assets",
              "every fault of doors and of anybody's URDF, MJCF, SDF, USDA, glTF and meshes"},
    FrontVerb{"export", "doorforge-assets",
              "doors for other simulators: MJCF, SDF, GLB, USDA, URDF"},
    FrontVerb{"conformance", "doorforge-assets",
              "do exports hold and open in other physics engines"},
    FrontVerb{"preview", "doorforge-assets", "pictures of parts and doors"},
    FrontVerb{"view", "doorforge-assets", "doors and parts in 3D, on a page that needs no network"},
    FrontVerb{"serve", "doorforge-assets", "compose doors in the browser, on this machine alone"},
    FrontVerb{"simulate", "doorforge-simulate", "the rule-based expert on doors, with film strips"},
    FrontVerb{"datagen", "doorforge-datagen", "collect a stage's dataset shards"},
    FrontVerb{"dataset", "doorforge-datagen", "verify and describe datasets"},
    FrontVerb{"train", "doorforge-train", "train a stage's policy from shards"},
    FrontVerb{"eval", "doorforge-eval", "success of a policy per category, with a report"},
    FrontVerb{"benchmark", "doorforge-eval", "the paper's table: baselines, ablations, ours"},
    FrontVerb{"report", "doorforge-eval", "one table of the reports of several trainings"},
    FrontVerb{"act", "doorforge-act", "a real depth picture -> the hand's next pose"},
    FrontVerb{"serve-policy", "doorforge-serve-policy", "a policy for robot stacks, by WebSocket"},
    FrontVerb{"sight", "doorforge-sight", "a simulated door as the pictures that act reads"},
    FrontVerb{"schema", "", "JSON Schemas of records and settings"},
    FrontVerb{"doctor", "doorforge-train", "what is installed, and what to do about it"},
};

// A build without a room does not offer its verbs.
bool IsBuilt(const FrontVerb& verb) {
  return std::filesystem::exists(ProgramFolder() / verb.program);
}

void PrintDescription() {
  nlohmann::ordered_json verbs = nlohmann::ordered_json::array();
  for (const FrontVerb& verb : kVerbs) {
    if (IsBuilt(verb))
      verbs.push_back({{"name", verb.name}, {"program", verb.program}, {"about", verb.does}});
  }
  const nlohmann::ordered_json json = {
      {"name", "doorforge"},
      {"about", kAbout},
      {"footer", kExample},
      {"options",
       {{{"names", {"-h", "--help"}}, {"about", "lists the verbs"}},
        {{"names", {"--version"}}, {"about", "version and commit"}}}},
      {"verbs", verbs}};
  std::printf("%s\n", json.dump(2).c_str());
}

void PrintHelp() {
  std::printf(
      "doorforge %s: %s\n\n"
      "usage: doorforge VERB [ARGUMENTS]     doorforge VERB --help\n\n",
      CodeVersion().c_str(), kAbout);
  for (const FrontVerb& verb : kVerbs) {
    if (IsBuilt(verb)) std::printf("  %-13s %s\n", verb.name, verb.does);
  }
  std::printf("\n%s\n", kExample);
}

const FrontVerb& FindVerb(const std::string& name) {
  if (name.starts_with('-'))
    throw Error(ErrorCode::kInvalidArgument, "unknown option \"" + name + "\"; did you mean \"" +
                                                 NearestName(name, {"--help", "--version"}) +
                                                 "\"? `doorforge --help` lists all");
  std::vector<std::string> names;
  for (const FrontVerb& verb : kVerbs) {
    if (name == verb.name) return verb;
    names.emplace_back(verb.name);
  }
  RefuseVerb(name, names);
}

int Run(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "--help";
  if (name == "--help" || name == "-h" || name == "help") {
    PrintHelp();
    return 0;
  }
  if (name == kDescribeCommand) {
    PrintDescription();
    return 0;
  }
  if (name == "--version") {
    std::printf("%s\n", CodeVersion().c_str());
    return 0;
  }
  const FrontVerb& verb = FindVerb(name);
  if (name == "quickstart") return RunQuickstartVerb(argc - 1, argv + 1);
  if (name == "schema") return RunSchemaVerb(argc - 1, argv + 1);
  if (name == "pipeline") return RunPipelineVerb(argc - 1, argv + 1);
  const std::string program = (ProgramFolder() / verb.program).string();
  ::execv(program.c_str(), argv);
  throw Error(ErrorCode::kMissing, program + ": cannot be started: " + std::strerror(errno) +
                                       "; this build lacks the room that offers `" + name + "`");
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] { return doorforge::Run(argc, argv); });
}
