// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "doorforge/authoring/part_batch.h"
#include "doorforge/catalogue/describe_catalogue.h"
#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/program.h"

#include "verbs.h"

namespace doorforge {
namespace {

struct CatalogOptions {
  CatalogueSelection selection;
  std::string id;
  std::string out;
  Existing existing = Existing::kRefuse;
  int threads = 0;
  bool json = false;
};

int List(const CatalogOptions& options) {
  const std::vector<CatalogueEntry> entries = SelectParts(DataFolder(), options.selection);
  PrintAnswer(options.json, CatalogueToJson(entries), CatalogueText(entries));
  return 0;
}

int Show(const CatalogOptions& options) {
  const CatalogueEntry entry = FindCatalogueEntry(ListCatalogue(DataFolder()), options.id);
  const Part part = BuildCataloguePart(entry);
  PrintAnswer(options.json, DescribePart(entry, part), PartText(entry, part));
  return 0;
}

int Build(const CatalogOptions& options) {
  const std::vector<CatalogueEntry> entries = SelectParts(DataFolder(), options.selection);
  const std::vector<std::string> problems =
      BuildParts(entries, options.out, options.existing, options.threads);
  std::vector<std::string> told;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (!problems[i].empty()) told.push_back(entries[i].id + ": " + problems[i]);
  }
  return AnswerOfBatch(
      told, options.json, BuiltToJson(entries, problems),
      std::to_string(entries.size() - told.size()) + " parts built in " + options.out + "\n");
}

}  // namespace

int RunCatalogVerb(int argc, char** argv) {
  CatalogOptions options;
  CLI::App app("Lists, shows and builds the parts of the embedded catalogue.", "doorforge catalog");
  app.require_subcommand(1);
  CLI::App* list = app.add_subcommand("list", "one line a part");
  CLI::App* show = app.add_subcommand("show", "what one part consists of");
  CLI::App* build = app.add_subcommand("build", "writes parts: DIR/<id>/part.json and meshes");
  show->add_option("ID", options.id, "id of a part")->required();
  build->add_option("--out", options.out, "folder of the parts")->required();
  AddThreads(*build, options.threads);
  AddOverwrite(*build, options.existing, "replace parts that are there already");
  for (CLI::App* verb : {list, build}) {
    verb->add_option("--category", options.selection.category, "only this category");
    verb->add_option("--split", options.selection.split,
                     "only parts of this split: a name in data/splits or a file");
  }
  for (CLI::App* verb : {list, show, build}) AddJson(*verb, options.json);
  app.footer(
      "examples:\n"
      "  doorforge catalog list --category interior\n"
      "  doorforge catalog show interior_lever_tube_01\n"
      "  doorforge catalog build --split quickstart --out parts");
  ParseVerb(app, argc, argv);
  if (list->parsed()) return List(options);
  if (show->parsed()) return Show(options);
  return Build(options);
}

}  // namespace doorforge
