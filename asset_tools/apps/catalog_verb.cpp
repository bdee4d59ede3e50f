// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
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

using Json = nlohmann::ordered_json;

struct CatalogOptions {
  std::string category;
  std::string split;
  std::string id;
  std::string out;
  int threads = 0;
  bool json = false;
  bool overwrite = false;
};

std::vector<CatalogueEntry> Chosen(const CatalogOptions& options) {
  return SelectParts(DataFolder(), {.category = options.category, .split = options.split});
}

int List(const CatalogOptions& options) {
  const std::vector<CatalogueEntry> entries = Chosen(options);
  if (options.json) {
    Json parts = Json::array();
    for (const CatalogueEntry& entry : entries) parts.push_back(EntryToJson(entry));
    PrintJson({{"schema", "doorforge.catalog"}, {"schema_version", 1}, {"parts", parts}});
    return 0;
  }
  for (const CatalogueEntry& entry : entries)
    std::printf("%-28s %-7s %-17s %-6s %s\n", entry.id.c_str(), NameOf(entry.role).data(),
                NameOf(entry.category).data(), NameOf(entry.mechanism).data(),
                entry.family.c_str());
  return 0;
}

int Show(const CatalogOptions& options) {
  const CatalogueEntry entry = FindCatalogueEntry(ListCatalogue(DataFolder()), options.id);
  const Part part = BuildCataloguePart(entry);
  if (options.json) {
    PrintJson(DescribePart(entry, part));
    return 0;
  }
  std::printf("%s: %s of category %s, mechanism %s, family %s\n%s\n", part.id.c_str(),
              NameOf(part.role).data(), NameOf(part.category).data(), NameOf(part.mechanism).data(),
              entry.family.c_str(), entry.recipe.c_str());
  for (const PartPiece& piece : part.pieces)
    std::printf("  %-6s %5zu triangles, %2zu convex pieces, %.3f kg\n", piece.name.c_str(),
                piece.mesh.triangles.size(), piece.hulls.size(), piece.mass.mass_kg);
  return 0;
}

int Build(const CatalogOptions& options) {
  const std::vector<CatalogueEntry> entries = Chosen(options);
  const std::vector<std::string> problems =
      BuildParts(entries, options.out, options.overwrite ? Existing::kReplace : Existing::kRefuse,
                 options.threads);
  std::size_t failed = 0;
  Json parts = Json::array();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    Json part = EntryToJson(entries[i]);
    part["built"] = problems[i].empty();
    part["message"] = problems[i];
    parts.push_back(part);
    if (problems[i].empty()) continue;
    ++failed;
    std::fprintf(stderr, "doorforge: %s: %s\n", entries[i].id.c_str(), problems[i].c_str());
  }
  if (options.json)
    PrintJson({{"schema", "doorforge.catalog_build"}, {"schema_version", 1}, {"parts", parts}});
  else
    std::printf("%zu parts built in %s\n", entries.size() - failed, options.out.c_str());
  return ExitCodeOfBatch(failed);
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
  AddOverwrite(*build, options.overwrite, "replace parts that are there already");
  for (CLI::App* verb : {list, build}) {
    verb->add_option("--category", options.category, "only this category");
    verb->add_option("--split", options.split,
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
