// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// The program that makes and checks datasets.

#include <CLI/CLI.hpp>

#include "doorforge/cli/command_line.h"
#include "doorforge/cli/verb_table.h"

#include "verbs.h"

namespace doorforge {
namespace {

int RunDatasetVerb(int argc, char** argv) {
  CLI::App app("Checks and describes datasets.", "doorforge dataset");
  app.require_subcommand(1);
  app.footer("examples:\n  doorforge dataset verify data/open\n  doorforge dataset info data/open");
  const Subcommand subcommands[] = {AddVerify(app), AddMerge(app), AddReobserve(app),
                                    AddStatus(app), AddInfo(app),  AddExport(app),
                                    AddCard(app),   AddFilms(app)};
  ParseVerb(app, argc, argv, EmptyValues::kRefuse);
  for (const Subcommand& subcommand : subcommands) {
    if (subcommand.app->parsed()) return subcommand.run();
  }
  return 0;  // not reached: the parser asks for a subcommand
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  constexpr doorforge::Verb kVerbs[] = {{"datagen", doorforge::RunDatagenVerb},
                                        {"dataset", doorforge::RunDatasetVerb}};
  return doorforge::RunVerbs(kVerbs, argc, argv);
}
