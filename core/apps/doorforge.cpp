// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The front program: `doorforge VERB ...` runs the program of the room that owns the verb, so that
// authoring an asset never waits for the training libraries to load.

#include <array>

#include "doorforge/cli/front_program.h"

#include "verbs.h"

namespace doorforge {
namespace {

constexpr std::array kVerbs = {
    FrontVerb{"quickstart", "", "the whole chain at small size, ends in report.html",
              RunQuickstartVerb},
    FrontVerb{"pipeline", "", "collect, train and evaluate all stages, step by step",
              RunPipelineVerb},
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
    FrontVerb{"reinforce", "doorforge-reinforce", "train a flying hand by trying, from states"},
    FrontVerb{"eval", "doorforge-eval", "success of a policy per category, with a report"},
    FrontVerb{"benchmark", "doorforge-eval", "the paper's table: baselines, ablations, ours"},
    FrontVerb{"report", "doorforge-eval", "one table of the reports of several trainings"},
    FrontVerb{"act", "doorforge-act", "a real depth picture -> the hand's next pose"},
    FrontVerb{"serve-policy", "doorforge-serve-policy", "a policy for robot stacks, by WebSocket"},
    FrontVerb{"sight", "doorforge-sight", "a simulated door as the pictures that act reads"},
    FrontVerb{"schema", "", "JSON Schemas of records and settings", RunSchemaVerb},
    FrontVerb{"doctor", "doorforge-train", "what is installed, and what to do about it"},
};

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunFrontProgram(
      {.name = "doorforge",
       .about = "door assets and door-opening data for robot learning",
       .example = "example:\n  doorforge quickstart --out run/quickstart",
       .verbs = doorforge::kVerbs},
      argc, argv);
}
