// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/output_file.h"
#include "doorforge/mesh/mesh_writer.h"
#include "doorforge/mesh/repair_file.h"

#include "verbs.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct RepairOptions {
  std::string input;
  std::string output;
  std::string report;
  std::string config;
  std::vector<std::string> settings;
  std::optional<WrapUse> wrap;
  double max_seconds = kObjectSeconds;
  bool json = false;
  Existing existing = Existing::kRefuse;
};

RepairOptions OptionsOf(int argc, char** argv) {
  RepairOptions options;
  CLI::App app("Turns any mesh into a closed, oriented one and measures what that changed.",
               "doorforge repair");
  app.add_option("IN", options.input, "mesh: .obj .stl .ply .dae .gltf .glb .fbx .3ds .off")
      ->required();
  app.add_option("OUT", options.output, "closed mesh: .obj .stl .ply")->required();
  AddJson(app, options.json, "print the report as one JSON document");
  app.add_option("--report", options.report, "where to write the report (OUT.report.json)");
  AddOverwrite(app, options.existing, "replace OUT and its report");
  AddConfig(app, options.config, "YAML file with settings of the repair");
  AddSettings(app, options.settings, "one setting, such as max_triangles=2000");
  AddChoice(app, "--wrap", options.wrap,
            "alpha wrap: never, auto (where exact repair fails) or always");
  AddMaxSeconds(app, options.max_seconds,
                "processor time that it may take before it is given up (300)");
  app.footer(
      "settings: alpha_fraction 0.01, offset_fraction 0.000833, max_hole_fraction 0.05,\n"
      "max_flat_hole_share 0.15, max_cap_fraction 0.01, max_triangles 6000, max_pairs 100000\n"
      "exit code: 0 closed, 1 the mesh cannot be closed, 2 wrong use, 3 IN cannot be read\n"
      "example:\n  doorforge repair handle.stl handle.obj --set max_triangles=2000");
  ParseVerb(app, argc, argv);
  if (options.report.empty()) options.report = options.output + ".report.json";
  return options;
}

RepairConfig ConfigOf(const RepairOptions& options) {
  auto config = LoadConfig<RepairConfig>(options.config, options.settings);
  if (options.wrap) config.wrap = *options.wrap;
  return config;
}

// Refuses before the work starts what would be refused after it.
void CheckOutputs(const RepairOptions& options) {
  WriterFor(options.output);
  for (const std::string& path : {options.output, options.report}) {
    RequireNoFile(path, options.existing == Existing::kReplace);
    RequireWritable(fs::absolute(path).parent_path());
  }
}

}  // namespace

int RunRepairVerb(int argc, char** argv) {
  const RepairOptions options = OptionsOf(argc, argv);
  const RepairConfig config = ConfigOf(options);
  CheckOutputs(options);
  const auto [result, record] = NamingConfig(
      options.config, [&] { return RepairMeshFile(options.input, config, options.max_seconds); });
  if (result.mesh) {
    CommitFile(options.output, WriterFor(options.output)(result.mesh->mesh()), options.existing);
    CommitFile(options.report, JsonText(record, 2) + "\n", options.existing);
  }
  PrintAnswer(options.json, record, options.input + ": " + RepairText(result.report));
  return result.mesh ? 0 : 1;
}

}  // namespace doorforge
