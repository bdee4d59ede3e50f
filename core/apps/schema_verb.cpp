// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <CLI/CLI.hpp>

#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/published_schemas.h"

#include "verbs.h"

namespace doorforge {

int RunSchemaVerb(int argc, char** argv) {
  std::string name;
  CLI::App app("Prints the JSON Schema of a record or of settings.", "doorforge schema");
  app.add_option("NAME", name, "which one; without it, their names are listed");
  app.footer("example:\n  doorforge schema validation_settings");
  ParseVerb(app, argc, argv);
  if (!name.empty()) {
    PrintText(PublishedSchema(name));
    return 0;
  }
  for (const std::string& known : PublishedSchemas()) PrintText(known + "\n");
  return 0;
}

}  // namespace doorforge
