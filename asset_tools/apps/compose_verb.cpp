// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "doorforge/authoring/compose_doors.h"
#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#ifdef DOORFORGE_WITH_PREVIEW
#include "doorforge/preview/draw_records.h"
#endif
#include "doorforge/validate/validate_door.h"

#include "mesh_options.h"
#include "validator.h"
#include "verbs.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct ComposeOptions {
  std::string body;
  std::string handle;
  std::string out;
  std::string parts;
  std::string category;
  std::string config;
  std::optional<HandlePlace> place;
  std::vector<std::string> settings;
  LooseMeshConfig body_mesh = UnsetMeshOptions();
  LooseMeshConfig handle_mesh = UnsetMeshOptions();
  int threads = 0;
  double max_seconds = kObjectSeconds;
  bool all = false;
  bool as_imported = false;
  bool standalone = false;
  bool preview = false;
  bool validate = false;
  Existing existing = Existing::kRefuse;
  bool json = false;
  bool quiet = false;
  bool rules = false;
};

void AddOptions(CLI::App& app, ComposeOptions& options) {
  app.add_option("--body", options.body,
                 "id in the catalogue or in --parts, a part's folder, a glob of either, or what "
                 "`doorforge import` reads, such as a mesh file");
  app.add_option("--handle", options.handle, "the same");
  app.add_option("--out", options.out, "folder of the door; of the doors where there may be many");
  app.add_flag("--all", options.all, "every body with every handle of its category");
  app.add_flag("--as-imported", options.as_imported,
               "with --parts: the pairs that the imported objects were composed of");
  app.add_option("--parts", options.parts, "folder of parts; the catalogue if left out");
  app.add_option("--category", options.category,
                 "with many doors: only this category; of a door whose body and handle are both "
                 "imported on the way");
  AddHandleMeshOptions(app, "handle-", options.handle_mesh);
  AddMeshOptions(app, "handle-", options.handle_mesh);
  AddBodyMeshOptions(app, "body-", options.body_mesh);
  AddMeshOptions(app, "body-", options.body_mesh);
  AddChoice(
      app, "--place", options.place,
      "seat: the body's mount, the handle's back on the leaf; plane: the same with the "
      "handle's own plane of mounting; author: as on the object that both were imported from; "
      "axis: about the same axis, on the leaf; auto: axis for parts of one object, plane with "
      "--handle-mount, else seat");
  AddConfig(app, options.config, "YAML file with body, handle and all settings");
  AddSettings(app, options.settings, "overrides one setting");
  app.add_flag("--standalone", options.standalone,
               "many doors: each with its own copy of the meshes");
  app.add_flag("--validate", options.validate,
               "one door: validate and simulate it, write validation.json; always with imported "
               "parts");
#ifdef DOORFORGE_WITH_PREVIEW
  app.add_flag("--preview", options.preview, "one door: write its picture thumb.png");
#endif
  AddThreads(app, options.threads, "0: all processors; no byte depends on it");
  AddMaxSeconds(app, options.max_seconds);
  AddOverwrite(app, options.existing, "replace doors that are there already");
  AddJson(app, options.json);
  app.add_flag("--quiet", options.quiet, "print nothing but errors");
  app.add_flag("--rules", options.rules, "list the rules of pairs and the presets, and end");
  app.footer(
      "Many doors share the meshes of their parts in OUT/pool; a door alone, or --standalone, has\n"
      "its own. A run that was ended goes on where it was when it is given again.\n"
      "examples:\n"
      "  doorforge compose --body interior_flush_01 --handle interior_lever_tube_01 --out doors/a\n"
      "  doorforge compose --body interior_flush_01 --handle my_lever.stl --handle-mechanism lever "
      "\\\n"
      "      --handle-up y --handle-front z --out doors/mine --preview\n"
      "  doorforge compose --body 'interior_*_panel_*' --handle 'interior_lever*' --out doors \\\n"
      "      --set hinge_side=right\n"
      "  doorforge compose --all --category interior --out doors");
}

void CheckOptions(const ComposeOptions& options) {
  const auto fail = [](const std::string& why) {
    throw Error(ErrorCode::kInvalidArgument, why + "; see `doorforge compose --help`");
  };
  if (options.out.empty()) fail("--out is required");
  if (options.all && options.as_imported) fail("--all and --as-imported exclude each other");
  if ((options.all || options.as_imported) && !(options.body.empty() && options.handle.empty()))
    fail("--all and --as-imported take no --body and --handle");
  if (options.as_imported && options.parts.empty()) fail("--as-imported needs --parts");
  if (!options.category.empty()) RequireCategory("--category", options.category);
}

ComposeOptions ParseCompose(int argc, char** argv) {
  ComposeOptions options;
  CLI::App app("Composes doors: a body and a handle of one category.", "doorforge compose");
  AddOptions(app, options);
  ParseVerb(app, argc, argv);
  if (!options.rules) CheckOptions(options);
  return options;
}

ComposeRequest RequestOf(const ComposeOptions& options) {
  auto request = LoadConfig<ComposeRequest>(options.config, options.settings);
  if (!options.body.empty()) request.body = options.body;
  if (!options.handle.empty()) request.handle = options.handle;
  if (options.place) request.door.place = *options.place;
  if (!options.category.empty()) request.category = options.category;
  AssignGiven(options.body_mesh, UnsetMeshOptions(), request.body_mesh);
  AssignGiven(options.handle_mesh, UnsetMeshOptions(), request.handle_mesh);
  if (options.all || options.as_imported) return request;
  if (request.body.empty() || request.handle.empty())
    throw Error(
        ErrorCode::kInvalidArgument,
        (options.config.empty() ? "" : options.config + " names no pair of parts: ") +
            "--body and --handle (or both in --config), --all or --as-imported is required; "
            "see `doorforge compose --help`");
  return request;
}

ComposeRun RunOf(const ComposeOptions& options) {
  ComposeRun run{.out = options.out, .parts = options.parts};
  if (options.all) run.pairs = PairChoice::kAll;
  if (options.as_imported) run.pairs = PairChoice::kAsImported;
  run.category = options.category;
  run.standalone = options.standalone;
  run.existing = options.existing;
  run.threads = options.threads;
  run.max_seconds = options.max_seconds;
  run.note = PrintNote;
  // a name that no option gave is the settings file's
  if (!options.config.empty() && options.body.empty())
    run.body_named_by = options.config + ": body";
  if (!options.config.empty() && options.handle.empty())
    run.handle_named_by = options.config + ": handle";
  return run;
}

int Finish(const std::vector<ComposedDoor>& doors, const ComposeOptions& options) {
  std::size_t failed = 0;
  std::size_t kept = 0;
  for (const ComposedDoor& door : doors) {
    kept += door.kept ? 1 : 0;
    if (door.problem.empty()) continue;
    ++failed;
    PrintNote(door.id + ": " + door.problem);
  }
  const auto also = [](std::size_t count, const char* what) {
    return count == 0 ? std::string() : ", " + std::to_string(count) + what;
  };
  if (options.json || !options.quiet)
    PrintAnswer(options.json, ComposedToJson(doors),
                Counted(doors.size() - failed, "door") + " composed in " + options.out +
                    also(kept, " of them there already") + also(failed, " not") + "\n");
  return ExitCodeOfBatch(failed);
}

// The door as it was written: what was imported is always looked at.
int Check(const ComposeOptions& options, bool imported) {
  int errors = 0;
  if (options.validate || imported) {
    const std::unique_ptr<DoorValidator> openable = OpenableValidator();
    const ValidationReport report =
        openable ? openable->Door(options.out) : ValidateDoor(options.out);
    WriteJsonFile(fs::path(options.out) / "validation.json", ToJson(std::span(&report, 1)));
    errors = report.errors;
    for (const Finding& finding : report.findings)
      PrintNote(finding.code + " " + std::string(NameOf(finding.severity)) + " " + finding.where +
                ": measured " + finding.measured + "; allowed " + finding.allowed +
                "; to fix: " + finding.fix);
    if (!options.json && !options.quiet)
      PrintText("validated: " + CountedFindings(report.errors, report.warnings) + "\n");
  }
#ifdef DOORFORGE_WITH_PREVIEW
  if (options.preview) {
    const fs::path png = fs::path(options.out) / "thumb.png";
    const fs::path folder = options.out;
    WritePng(png, DrawRecords({&folder, 1}, {.focus = "all"}));
    if (!options.json && !options.quiet) PrintText("picture: " + png.string() + "\n");
  }
#endif
  return errors == 0 ? 0 : 1;
}

int Compose(const ComposeOptions& options, const ComposeRequest& request) {
  const ComposeRun run = RunOf(options);
  if (MeansManyDoors(run, request)) {
    const ComposedDoors composed = ComposeManyDoors(run, request);
    const int code = Finish(composed.doors, options);
    return code == 0 && composed.damaged_parts > 0 ? 1 : code;
  }
  const ComposedDoors composed = ComposeOneDoor(run, request);
  const int code = Finish(composed.doors, options);
  return std::max(code, Check(options, composed.imported));
}

}  // namespace

int RunComposeVerb(int argc, char** argv) {
  const ComposeOptions options = ParseCompose(argc, argv);
  if (options.rules) {
    PrintText(ComposeRulesText());
    return 0;
  }
  const ComposeRequest request = RequestOf(options);
  return NamingConfig(options.config, [&] { return Compose(options, request); });
}

}  // namespace doorforge
