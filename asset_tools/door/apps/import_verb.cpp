// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "import_verb.h"

#include <cstdio>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "doorforge/core/config_file.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/program.h"
#include "doorforge/door/import_objects.h"

#include "verb_options.h"

namespace doorforge {
namespace {

struct Options {
  std::string source;
  std::string out;
  std::string format = "auto";
  std::string category;
  std::string config;
  std::vector<std::string> settings;
  int threads = 0;
  bool overwrite = false;
  bool json = false;
};

Options Parse(int argc, char** argv) {
  Options options;
  CLI::App app("Imports composed door objects: each gives a body part and a handle part.",
               "doorforge import");
  app.add_option("SRC", options.source,
                 "one object (a folder with mobility.urdf) or a folder of them")
      ->required();
  app.add_option("--out", options.out, "folder for the parts")->required();
  app.add_option("--format", options.format, "auto or unidoormanip")
      ->check(CLI::IsMember({"auto", "unidoormanip"}));
  app.add_option("--category", options.category,
                 "interior, window, car, safe, storagefurniture or refrigerator; told by the "
                 "object's folder or content if left out");
  app.add_option("--config", options.config, "YAML file with the settings of import");
  app.add_option("--set", options.settings, "a.b=c overrides one setting");
  app.add_option("--threads", options.threads, "0: all processors");
  app.add_flag("--overwrite", options.overwrite, "replace parts that are there already");
  app.add_flag("--json", options.json, "print one JSON document");
  app.footer("example:\n  doorforge import shared/unidoormanip_objects/LeverDoor --out parts");
  ParseVerb(app, argc, argv);
  return options;
}

std::string GraspNote(const ImportedObject& object) {
  return object.grasp_holds ? "" : "  (no grasp that holds was found)";
}

void PrintTable(const ImportReport& report) {
  for (const ImportedObject& object : report.objects) {
    if (object.outcome == ImportOutcome::kImported) {
      std::printf("%-26s %-16s %-14s %s%s\n", object.name.c_str(), object.category.c_str(),
                  object.body_id.c_str(), object.handle_id.c_str(), GraspNote(object).c_str());
    } else {
      std::fprintf(stderr, "doorforge: %s: %s: %s\n", object.name.c_str(),
                   std::string(NameOf(object.outcome)).c_str(), object.message.c_str());
    }
  }
  std::map<ImportOutcome, int> counts;
  for (const ImportedObject& object : report.objects) ++counts[object.outcome];
  std::printf("%zu objects:", report.objects.size());
  for (const auto& [outcome, count] : counts)
    std::printf(" %d %s", count, std::string(NameOf(outcome)).c_str());
  std::printf("\n");
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
  const Options options = Parse(argc, argv);
  auto config = LoadConfig<ImportConfig>(options.config, options.settings);
  if (!options.category.empty()) config.category = options.category;
  if (options.threads != 0) config.threads = options.threads;
  if (!config.category.empty() && !CategoryNamed(config.category))
    throw Error(ErrorCode::kInvalidArgument,
                "--category: unknown category \"" + config.category +
                    "\"; allowed are interior, window, car, safe, storagefurniture, refrigerator");
  const ImportReport report =
      ImportObjects(FindObjects(options.source), options.out, config,
                    options.overwrite ? Existing::kReplace : Existing::kRefuse);
  if (options.json)
    std::cout << ToJson(report).dump(2) << '\n';
  else
    PrintTable(report);
  return ExitCodeFor(report);
}

}  // namespace doorforge
