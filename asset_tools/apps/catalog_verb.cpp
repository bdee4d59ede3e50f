// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "doorforge/authoring/part_batch.h"
#include "doorforge/catalogue/catalogue.h"
#include "doorforge/cli/answer.h"
#include "doorforge/cli/command_line.h"
#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/schemas/split.h"

#include "verbs.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Options {
  std::string category;
  std::string split;
  std::string id;
  std::string out;
  int threads = 0;
  bool json = false;
  bool overwrite = false;
};

std::vector<CatalogueEntry> Chosen(const Options& options) {
  if (!options.category.empty() && !CategoryNamed(options.category))
    throw Error(ErrorCode::kInvalidArgument,
                "--category: unknown category \"" + options.category +
                    "\"; allowed are interior, window, car, safe, storagefurniture, refrigerator");
  const std::vector<CatalogueEntry> catalogue = ListCatalogue(DataFolder());
  std::vector<CatalogueEntry> chosen;
  if (options.split.empty()) {
    chosen = catalogue;
  } else {
    const fs::path path = DataFolder() / "splits" / (options.split + ".yaml");
    for (const std::string& id :
         PartsOf(ReadSplit(fs::exists(path) ? path : fs::path(options.split))))
      chosen.push_back(FindCatalogueEntry(catalogue, id));
  }
  std::erase_if(chosen, [&](const CatalogueEntry& entry) {
    return !options.category.empty() && NameOf(entry.category) != options.category;
  });
  if (chosen.empty())
    throw Error(ErrorCode::kMissing,
                "catalog: there are no parts of category \"" + options.category + "\" here");
  return chosen;
}

Json ToJson(const CatalogueEntry& entry) {
  return {{"id", entry.id},
          {"role", NameOf(entry.role)},
          {"category", NameOf(entry.category)},
          {"mechanism", NameOf(entry.mechanism)},
          {"family", entry.family}};
}

int List(const Options& options) {
  const std::vector<CatalogueEntry> entries = Chosen(options);
  if (options.json) {
    Json parts = Json::array();
    for (const CatalogueEntry& entry : entries) parts.push_back(ToJson(entry));
    PrintJson({{"schema", "doorforge.catalog"}, {"schema_version", 1}, {"parts", parts}});
    return 0;
  }
  for (const CatalogueEntry& entry : entries)
    std::printf("%-28s %-7s %-17s %-6s %s\n", entry.id.c_str(), NameOf(entry.role).data(),
                NameOf(entry.category).data(), NameOf(entry.mechanism).data(),
                entry.family.c_str());
  return 0;
}

Json PieceToJson(const PartPiece& piece) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : piece.mesh.vertices) bounds.extend(vertex);
  return {{"name", piece.name},
          {"triangles", piece.mesh.triangles.size()},
          {"hulls", piece.hulls.size()},
          {"mass_kg", piece.mass.mass_kg},
          {"size_m", Vector3ToJson(bounds.sizes())}};
}

int Show(const Options& options) {
  const CatalogueEntry entry = FindCatalogueEntry(ListCatalogue(DataFolder()), options.id);
  const Part part = BuildCataloguePart(entry);
  Json json = {{"schema", "doorforge.catalog_part"}, {"schema_version", 1}};
  json.update(ToJson(entry));
  json["license"] = part.license;
  json["recipe"] = entry.recipe.string();
  json["content_sha256"] = ContentHash(part);
  if (part.role == PartRole::kBody)
    json["part_from_mount"] = TransformToJson(part.part_from_mount);
  else
    json["part_from_grasp"] = TransformToJson(part.part_from_grasp);
  json["pieces"] = Json::array();
  for (const PartPiece& piece : part.pieces) json["pieces"].push_back(PieceToJson(piece));
  if (options.json) {
    PrintJson(json);
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

int Build(const Options& options) {
  const std::vector<CatalogueEntry> entries = Chosen(options);
  const std::vector<std::string> problems =
      BuildParts(entries, options.out, options.overwrite ? Existing::kReplace : Existing::kRefuse,
                 options.threads);
  std::size_t failed = 0;
  Json parts = Json::array();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    Json part = ToJson(entries[i]);
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
  Options options;
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
