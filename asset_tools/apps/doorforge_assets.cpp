// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The program that authors assets. It alone links CGAL and is therefore distributed under GPL-3.

#include <cstring>
#include <string>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"
#include "doorforge/core/program.h"

#include "catalog_verb.h"
#include "compose_verb.h"
#include "export_verb.h"
#include "import_verb.h"
#include "repair_verb.h"
#include "validate_verb.h"
#ifdef DOORFORGE_WITH_PREVIEW
#include "preview_verb.h"
#endif

namespace doorforge {
namespace {

struct Verb {
  const char* name;
  int (*run)(int argc, char** argv);
};

constexpr Verb kVerbs[] = {
    {"catalog", RunCatalogVerb}, {"compose", RunComposeVerb},
    {"export", RunExportVerb},   {"import", RunImportVerb},
#ifdef DOORFORGE_WITH_PREVIEW
    {"preview", RunPreviewVerb},
#endif
    {"repair", RunRepairVerb},   {"validate", RunValidateVerb},
};

int Run(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  std::vector<std::string> names;
  for (const Verb& verb : kVerbs) {
    if (name == verb.name) return verb.run(argc - 1, argv + 1);
    names.emplace_back(verb.name);
  }
  throw Error(ErrorCode::kInvalidArgument, "unknown verb \"" + name + "\"; did you mean \"" +
                                               NearestName(name, names) +
                                               "\"? `doorforge --help` lists all");
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] { return doorforge::Run(argc, argv); });
}
