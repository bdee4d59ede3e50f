// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/importers/import_objects.h"

#include "mesh_options.h"
#include "verbs.h"

namespace doorforge {
namespace {

struct ImportOptions {
  std::vector<std::filesystem::path> sources;
  std::string out;
  std::string format = "auto";
  std::string config;
  std::vector<std::string> settings;
  std::vector<std::string> only;
  ReadConfig read;  // what the flags say; an empty field leaves the config's
  int threads = 0;
  double max_seconds = 0;  // 0: the config's
  bool overwrite = false;
  bool json = false;
};

void AddReadOptions(CLI::App& app, ReadConfig& read) {
  app.add_option("--category", read.category,
                 "interior, window, car, safe, storagefurniture or refrigerator; told by the "
                 "object's folder or content if left out");
  app.add_option("--allow-missing", read.allow_missing,
                 "frame: objects that lack only the mesh of their frame are imported without");
  app.add_option("--height", read.height_m,
                 "height of the whole object in m, for data sets without a unit");
  read.mesh = UnsetMeshOptions();
  app.add_option("--role", read.mesh.role, "of loose meshes: body (a leaf) or handle");
  AddMeshOptions(app, "", read.mesh);
  AddHandleMeshOptions(app, "", read.mesh);
  AddBodyMeshOptions(app, "", read.mesh);
}

ImportOptions ParseImport(int argc, char** argv) {
  ImportOptions options;
  CLI::App app("Imports foreign door objects: each gives a body part and a handle part.",
               "doorforge import");
  app.add_option("SRC", options.sources, "objects, or folders of them up to three levels deep")
      ->required();
  app.add_option("--out", options.out, "folder for the parts")->required();
  std::vector<std::string> formats = ImportFormatNames();
  formats.insert(formats.begin(), "auto");
  app.add_option("--format", options.format, "auto, or the data set or kind of file")
      ->check(CLI::IsMember(formats));
  app.add_option("--only", options.only,
                 "import objects of these categories alone, such as interior,safe")
      ->delimiter(',')
      ->allow_extra_args(false);
  AddReadOptions(app, options.read);
  AddConfig(app, options.config, "YAML file with the settings of import");
  AddSettings(app, options.settings, "a.b=c overrides one setting");
  AddThreads(app, options.threads);
  AddMaxSeconds(app, options.max_seconds);
  AddOverwrite(app, options.overwrite, "replace parts that are there already");
  AddJson(app, options.json);
  app.footer(
      "examples:\n"
      "  doorforge import unidoormanip_objects/LeverDoor --out parts\n"
      "  doorforge import partnet_mobility/101593 --out parts --height 0.7\n"
      "  doorforge import handles/*.stl --role handle --category interior --out parts\n"
      "  doorforge import my_lever.stl --role handle --category interior --mechanism lever "
      "--unit mm --front z --up y --out parts");
  ParseVerb(app, argc, argv);
  return options;
}

template <class T>
void OverrideBy(T& value, const T& flag) {
  if (flag != T()) value = flag;
}

void OverrideRead(ReadConfig& config, const ReadConfig& flags) {
  OverrideBy(config.category, flags.category);
  OverrideBy(config.allow_missing, flags.allow_missing);
  OverrideBy(config.height_m, flags.height_m);
  OverrideMesh(config.mesh, flags.mesh);
}

std::string NotesOf(const ImportedObject& object) {
  std::string notes;
  if (!object.handle_id.empty() && !object.grasp_holds) notes = "no grasp that holds was found";
  for (const std::string& note : object.notes) notes += (notes.empty() ? "" : "; ") + note;
  return notes.empty() ? "" : "  (" + notes + ")";
}

const char* OrDash(const std::string& id) { return id.empty() ? "-" : id.c_str(); }

void PrintTable(const ImportReport& report) {
  for (const ImportedObject& object : report.objects) {
    if (object.outcome == ImportOutcome::kImported) {
      std::printf("%-26s %-16s %-14s %s%s\n", object.name.c_str(), object.category.c_str(),
                  OrDash(object.body_id), OrDash(object.handle_id), NotesOf(object).c_str());
    } else {
      std::fprintf(stderr, "doorforge: %s: %s: %s\n", object.name.c_str(),
                   std::string(NameOf(object.outcome)).c_str(), object.message.c_str());
    }
  }
  std::map<ImportOutcome, int> counts;
  for (const ImportedObject& object : report.objects) ++counts[object.outcome];
  std::printf("%s:", Counted(report.objects.size(), "object").c_str());
  for (const auto& [outcome, count] : counts)
    std::printf(" %d %s", count, std::string(NameOf(outcome)).c_str());
  std::printf("\n");
  if (report.left_out > 0)
    std::printf("%s of other categories left out\n",
                Counted(static_cast<std::size_t>(report.left_out), "object").c_str());
}

void CheckCategory(const std::string& option, const std::string& category) {
  if (CategoryNamed(category)) return;
  throw Error(ErrorCode::kInvalidArgument,
              option + ": unknown category \"" + category +
                  "\"; allowed are interior, window, car, safe, storagefurniture, refrigerator");
}

int ExitCodeFor(const ImportReport& report) {
  int failed = 0;
  for (const ImportedObject& object : report.objects)
    failed += object.outcome == ImportOutcome::kImported ? 0 : 1;
  if (const int signal = StopRequested()) return 128 + signal;
  if (failed == 0) return 0;
  // a single object is the input itself
  return report.objects.size() == 1 ? 3 : 1;
}

}  // namespace

int RunImportVerb(int argc, char** argv) {
  const ImportOptions options = ParseImport(argc, argv);
  auto config = LoadConfig<ImportConfig>(options.config, options.settings);
  OverrideRead(config.read, options.read);
  if (options.threads != 0) config.threads = options.threads;
  if (options.max_seconds > 0) config.max_seconds = options.max_seconds;
  if (!options.only.empty()) config.only = options.only;
  if (!config.read.category.empty()) CheckCategory("--category", config.read.category);
  for (const std::string& category : config.only) CheckCategory("--only", category);
  const std::vector<ForeignSource> objects = FindObjects(options.sources, options.format);
  const FolderLock lock(options.out, "doorforge import", Writers::kOne);
  const ImportReport report = NamingConfig(options.config, [&] {
    return ImportObjects(objects, options.out, config,
                         options.overwrite ? Existing::kReplace : Existing::kRefuse);
  });
  if (options.json)
    PrintJson(ToJson(report));
  else
    PrintTable(report);
  return ExitCodeFor(report);
}

}  // namespace doorforge
