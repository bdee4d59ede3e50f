// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/schemas/part.h"

namespace doorforge {

inline constexpr int kRecipeSchemaVersion = 1;

/// One part of the embedded catalogue, as the place of its recipe tells.
struct RecipeFile {
  std::string id;  ///< Unique in the catalogue; the recipe's file name without ".yaml".
  PartRole role = PartRole::kBody;
  Category category = Category::kInterior;
  std::filesystem::path recipe;  ///< The recipe's file.
};

/// One part of the embedded catalogue, as its recipe names it.
struct CatalogueEntry : RecipeFile {
  Mechanism mechanism = Mechanism::kNone;  ///< A body has kNone.
  std::string family;                      ///< The parametric family that builds it.
};

/// All recipes in the order of ListCatalogue(), of which none is read: that takes most of its time.
/// Throws as ListCatalogue() does, but for what a recipe says.
std::vector<RecipeFile> ListRecipes(const std::filesystem::path& data_folder);

/// The recipe with this id. Throws Error(kMissing) that suggests the nearest id.
RecipeFile FindRecipe(const std::vector<RecipeFile>& recipes, std::string_view id);

/// Reads all recipes below `<data_folder>/catalog/<category>/{bodies,handles}/<id>.yaml`, sorted by
/// category, role and id. Reads the head of each recipe only: parameters are checked when the part
/// is built. Throws Error(kMissing) without a catalogue, Error(kInvalidConfig) on a recipe with an
/// unknown key or family, a wrong id or one that occurs twice.
std::vector<CatalogueEntry> ListCatalogue(const std::filesystem::path& data_folder);

/// The entry with this id. Throws Error(kMissing) that suggests the nearest id.
CatalogueEntry FindCatalogueEntry(const std::vector<CatalogueEntry>& catalogue,
                                  std::string_view id);

/// Builds the part of a recipe: closed meshes, convex hulls, mass properties, joint, mount or
/// grasp. A pure function of the recipe's text and category. Throws Error(kInvalidConfig) as
/// ListCatalogue(), or naming the parameter, the value found and the range allowed.
Part BuildCataloguePart(const RecipeFile& file);

/// ListRecipes(), FindRecipe() and BuildCataloguePart() in one call.
Part BuildCataloguePart(const std::filesystem::path& data_folder, std::string_view id);

}  // namespace doorforge
