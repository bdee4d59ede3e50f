// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The program that makes and checks datasets.

#include <string>

#include "doorforge/core/error.h"
#include "doorforge/core/nearest_name.h"
#include "doorforge/core/program.h"

#include "verb_options.h"
#include "verbs.h"

namespace doorforge {
namespace {

int RunDatasetVerb(int argc, char** argv) {
  CLI::App app("Checks and describes datasets.", "doorforge dataset");
  app.require_subcommand(1);
  app.footer("examples:\n  doorforge dataset verify data/open\n  doorforge dataset info data/open");
  const Subcommand subcommands[] = {AddVerify(app), AddMerge(app), AddReobserve(app),
                                    AddStatus(app), AddInfo(app),  AddExport(app),
                                    AddCard(app)};
  ParseDataVerb(app, argc, argv);
  for (const Subcommand& subcommand : subcommands) {
    if (subcommand.app->parsed()) return subcommand.run();
  }
  return 0;  // not reached: the parser asks for a subcommand
}

int Run(int argc, char** argv) {
  const std::string verb = argc > 1 ? argv[1] : "";
  if (verb == "datagen") return RunDatagenVerb(argc - 1, argv + 1);
  if (verb == "dataset") return RunDatasetVerb(argc - 1, argv + 1);
  throw Error(ErrorCode::kInvalidArgument, "unknown verb \"" + verb + "\"; did you mean \"" +
                                               NearestName(verb, {"datagen", "dataset"}) +
                                               "\"? `doorforge --help` lists all");
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] { return doorforge::Run(argc, argv); });
}
