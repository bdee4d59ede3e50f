// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/folder_lock.h"
#include "doorforge/importers/import_objects.h"
#include "doorforge/schemas/names.h"

#include "mesh_options.h"
#include "verbs.h"

namespace doorforge {
namespace {

ReadConfig UnsetReadOptions() { return {.mesh = UnsetMeshOptions()}; }

struct ImportOptions {
  std::vector<std::filesystem::path> sources;
  std::string out;
  std::string format = "auto";
  std::string config;
  std::vector<std::string> settings;
  std::vector<std::string> only;
  ReadConfig read = UnsetReadOptions();  // what the flags say
  int threads = 0;
  double max_seconds = 0;  // 0: the config's
  Existing existing = Existing::kRefuse;
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
  AddOverwrite(app, options.existing, "replace parts that are there already");
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

}  // namespace

int RunImportVerb(int argc, char** argv) {
  const ImportOptions options = ParseImport(argc, argv);
  auto config = LoadConfig<ImportConfig>(options.config, options.settings);
  AssignGiven(options.read, UnsetReadOptions(), config.read);
  if (options.threads != 0) config.threads = options.threads;
  if (options.max_seconds > 0) config.max_seconds = options.max_seconds;
  if (!options.only.empty()) config.only = options.only;
  if (!config.read.category.empty()) RequireCategory("--category", config.read.category);
  for (const std::string& category : config.only) RequireCategory("--only", category);
  const std::vector<ForeignSource> objects = FindObjects(options.sources, options.format);
  const FolderLock lock(options.out, "doorforge import", Writers::kOne);
  const ImportReport report = NamingConfig(options.config, [&] {
    return ImportObjects(objects, options.out, config, options.existing);
  });
  const int code =
      AnswerOfBatch(FaultsOf(report), options.json, ToJson(report), ImportText(report));
  // a single object is the input itself
  return code == 1 && report.objects.size() == 1 ? 3 : code;
}

}  // namespace doorforge
