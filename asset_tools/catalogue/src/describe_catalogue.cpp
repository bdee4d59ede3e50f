// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/catalogue/describe_catalogue.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/schemas/split.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json PieceToJson(const PartPiece& piece) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : piece.mesh.vertices) bounds.extend(vertex);
  return {{"name", piece.name},
          {"triangles", piece.mesh.triangles.size()},
          {"hulls", piece.hulls.size()},
          {"mass_kg", piece.mass.mass_kg},
          {"size_m", Vector3ToJson(bounds.sizes())}};
}

}  // namespace

std::vector<CatalogueEntry> SelectParts(const fs::path& data_folder,
                                        const CatalogueSelection& selection) {
  if (!selection.category.empty()) RequireCategory("--category", selection.category);
  const std::vector<CatalogueEntry> catalogue = ListCatalogue(data_folder);
  std::vector<CatalogueEntry> chosen;
  if (selection.split.empty()) {
    chosen = catalogue;
  } else {
    const fs::path path = data_folder / "splits" / (selection.split + ".yaml");
    for (const std::string& id :
         PartsOf(ReadSplit(fs::exists(path) ? path : fs::path(selection.split))))
      chosen.push_back(FindCatalogueEntry(catalogue, id));
  }
  std::erase_if(chosen, [&](const CatalogueEntry& entry) {
    return !selection.category.empty() && NameOf(entry.category) != selection.category;
  });
  if (chosen.empty())
    throw Error(ErrorCode::kMissing,
                "catalog: there are no parts of category \"" + selection.category + "\" here");
  return chosen;
}

Json EntryToJson(const CatalogueEntry& entry) {
  return {{"id", entry.id},
          {"role", NameOf(entry.role)},
          {"category", NameOf(entry.category)},
          {"mechanism", NameOf(entry.mechanism)},
          {"family", entry.family}};
}

Json DescribePart(const CatalogueEntry& entry, const Part& part) {
  Json json = {{"schema", "doorforge.catalog_part"}, {"schema_version", 1}};
  json.update(EntryToJson(entry));
  json["license"] = part.license;
  json["recipe"] = entry.recipe.string();
  json["content_sha256"] = ContentHash(part);
  if (part.role == PartRole::kBody)
    json["part_from_mount"] = TransformToJson(part.part_from_mount);
  else
    json["part_from_grasp"] = TransformToJson(part.part_from_grasp);
  json["pieces"] = Json::array();
  for (const PartPiece& piece : part.pieces) json["pieces"].push_back(PieceToJson(piece));
  return json;
}

Json CatalogueToJson(const std::vector<CatalogueEntry>& entries) {
  Json parts = Json::array();
  for (const CatalogueEntry& entry : entries) parts.push_back(EntryToJson(entry));
  return {{"schema", "doorforge.catalog"}, {"schema_version", 1}, {"parts", parts}};
}

std::string CatalogueText(const std::vector<CatalogueEntry>& entries) {
  std::string text;
  for (const CatalogueEntry& entry : entries) {
    char line[256];
    std::snprintf(line, sizeof line, "%-28s %-7s %-17s %-6s %s\n", entry.id.c_str(),
                  NameOf(entry.role).data(), NameOf(entry.category).data(),
                  NameOf(entry.mechanism).data(), entry.family.c_str());
    text += line;
  }
  return text;
}

std::string PartText(const CatalogueEntry& entry, const Part& part) {
  std::string text = part.id + ": " + std::string(NameOf(part.role)) + " of category " +
                     std::string(NameOf(part.category)) + ", mechanism " +
                     std::string(NameOf(part.mechanism)) + ", family " + entry.family + "\n" +
                     entry.recipe.string() + "\n";
  for (const PartPiece& piece : part.pieces) {
    char line[256];
    std::snprintf(line, sizeof line, "  %-6s %5zu triangles, %2zu convex pieces, %.3f kg\n",
                  piece.name.c_str(), piece.mesh.triangles.size(), piece.hulls.size(),
                  piece.mass.mass_kg);
    text += line;
  }
  return text;
}

}  // namespace doorforge
