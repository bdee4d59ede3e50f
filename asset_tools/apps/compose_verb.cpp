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
#include "doorforge/foreign/finding_formats.h"
#include "doorforge/validate/validate_door.h"

#include "mesh_options.h"
#include "validator.h"
#include "verbs.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

struct ComposeOptions {
  ComposeRun run;
  std::string body;
  std::string handle;
  std::string config;
  std::optional<HandlePlace> place;
  std::vector<std::string> settings;
  LooseMeshConfig body_mesh = UnsetMeshOptions();
  LooseMeshConfig handle_mesh = UnsetMeshOptions();
  bool preview = false;
  bool validate = false;
  bool json = false;
  bool quiet = false;
  bool rules = false;
};

// Which pairs, in one of three ways.
void AddPairs(CLI::App& app, ComposeOptions& options) {
  auto* body =
      app.add_option("--body", options.body,
                     "id in the catalogue or in --parts, a part's folder, a glob of either, or "
                     "what `doorforge import` reads, such as a mesh file");
  auto* handle = app.add_option("--handle", options.handle, "the same");
  const auto add = [&](const char* name, PairChoice pairs, const char* about) {
    const auto choose = [&options, pairs] { options.run.pairs = pairs; };
    return app.add_flag_callback(name, choose, about)->excludes(body)->excludes(handle);
  };
  auto* all = add("--all", PairChoice::kAll, "every body with every handle of its category");
  auto* as_imported = add("--as-imported", PairChoice::kAsImported,
                          "with --parts: the pairs that the imported objects were composed of");
  as_imported->excludes(all)->needs(
      app.add_option("--parts", options.run.parts, "folder of parts; the catalogue if left out"));
}

void AddOptions(CLI::App& app, ComposeOptions& options) {
  ComposeRun& run = options.run;
  AddPairs(app, options);
  app.add_option("--out", run.out, "folder of the door; of the doors where there may be many");
  app.add_option("--category", run.category,
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
  app.add_flag("--standalone", run.standalone, "many doors: each with its own copy of the meshes");
  app.add_flag("--validate", options.validate,
               "one door: validate and simulate it, write validation.json; always with imported "
               "parts");
#ifdef DOORFORGE_WITH_PREVIEW
  app.add_flag("--preview", options.preview, "one door: write its picture thumb.png");
#endif
  AddThreads(app, run.threads, "0: all processors; no byte depends on it");
  AddMaxSeconds(app, run.max_seconds);
  AddOverwrite(app, run.existing, "replace doors that are there already");
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

ComposeOptions ParseCompose(int argc, char** argv) {
  ComposeOptions options;
  CLI::App app("Composes doors: a body and a handle of one category.", "doorforge compose");
  AddOptions(app, options);
  ParseVerb(app, argc, argv);
  Require(options.rules || !options.run.out.empty(), ErrorCode::kInvalidArgument,
          "--out is required; see `doorforge compose --help`");
  if (!options.run.category.empty()) RequireCategory("--category", options.run.category);
  options.run.note = PrintNote;
  // a name that no option gave is the settings file's
  if (!options.config.empty() && options.body.empty())
    options.run.body_named_by = options.config + ": body";
  if (!options.config.empty() && options.handle.empty())
    options.run.handle_named_by = options.config + ": handle";
  return options;
}

ComposeRequest RequestOf(const ComposeOptions& options) {
  auto request = LoadConfig<ComposeRequest>(options.config, options.settings);
  if (!options.body.empty()) request.body = options.body;
  if (!options.handle.empty()) request.handle = options.handle;
  if (options.place) request.door.place = *options.place;
  if (!options.run.category.empty()) request.category = options.run.category;
  AssignGiven(options.body_mesh, UnsetMeshOptions(), request.body_mesh);
  AssignGiven(options.handle_mesh, UnsetMeshOptions(), request.handle_mesh);
  const bool named = !request.body.empty() && !request.handle.empty();
  Require(named || options.run.pairs != PairChoice::kNamed, ErrorCode::kInvalidArgument,
          (options.config.empty() ? "" : options.config + " names no pair of parts: ") +
              "--body and --handle (or both in --config), --all or --as-imported is required; "
              "see `doorforge compose --help`");
  return request;
}

int Finish(const std::vector<ComposedDoor>& doors, const ComposeOptions& options) {
  const bool silent = options.quiet && !options.json;
  return AnswerOfBatch(ProblemsOf(doors), options.json, ComposedToJson(doors),
                       silent ? "" : ComposedText(doors, options.run.out));
}

// The door as it was written: what was imported is always looked at.
int Check(const ComposeOptions& options, bool imported) {
  const fs::path& folder = options.run.out;
  const bool silent = options.quiet || options.json;
  int errors = 0;
  if (options.validate || imported) {
    const std::unique_ptr<DoorValidator> openable = OpenableValidator();
    const ValidationReport report = openable ? openable->Door(folder) : ValidateDoor(folder);
    WriteJsonFile(folder / "validation.json", ToJson(std::span(&report, 1)));
    errors = report.errors;
    for (const Finding& finding : report.findings)
      PrintNote(finding.code + " " + std::string(NameOf(finding.severity)) + " " + finding.where +
                ": " + SentenceOf(finding));
    if (!silent) PrintText("validated: " + CountedFindings(report.errors, report.warnings) + "\n");
  }
#ifdef DOORFORGE_WITH_PREVIEW
  if (options.preview) {
    WritePng(folder / "thumb.png", DrawRecords({&folder, 1}, {.focus = PreviewFocus::kAll}));
    if (!silent) PrintText("picture: " + (folder / "thumb.png").string() + "\n");
  }
#endif
  return errors == 0 ? 0 : 1;
}

int Compose(const ComposeOptions& options, const ComposeRequest& request) {
  const bool many = MeansManyDoors(options.run, request);
  const ComposedDoors composed =
      many ? ComposeManyDoors(options.run, request) : ComposeOneDoor(options.run, request);
  const int code = Finish(composed.doors, options);
  if (many) return code == 0 && composed.damaged_parts > 0 ? 1 : code;
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
