// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/catalogue/catalogue.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/config_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/nearest_name.h"

#include "family.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecipeSchema = "doorforge.recipe";
constexpr const char* kCatalogueLicense = "CC0-1.0";

struct Recipe {  // NOLINT(bugprone-exception-escape): nlohmann's move may check its invariant
  std::string schema;
  int schema_version = 0;
  std::string id;
  std::string family;
  std::string license;
  nlohmann::ordered_json parameters;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("schema", self.schema);
    visit("schema_version", self.schema_version);
    visit("id", self.id);
    visit("family", self.family);
    visit("license", self.license);
    visit("parameters", self.parameters);
  }
};

[[noreturn]] void ThrowRecipeError(const fs::path& path, const std::string& problem) {
  throw Error(ErrorCode::kInvalidConfig, path.string() + ": " + problem);
}

Recipe ParseRecipe(const std::string& text, const fs::path& path) {
  Recipe recipe;
  Assign(ParseYaml(text, path.string()), recipe, path.string());
  if (recipe.schema != kRecipeSchema)
    ThrowRecipeError(path,
                     "schema is \"" + recipe.schema + "\", expected \"" + kRecipeSchema + '"');
  if (recipe.schema_version < 1 || recipe.schema_version > kRecipeSchemaVersion)
    ThrowRecipeError(path, "schema_version is " + std::to_string(recipe.schema_version) +
                               ", allowed 1 to " + std::to_string(kRecipeSchemaVersion));
  if (recipe.id != path.stem().string())
    ThrowRecipeError(path, "id is \"" + recipe.id + "\" but the file is named for \"" +
                               path.stem().string() + '"');
  if (recipe.license != kCatalogueLicense)
    ThrowRecipeError(path, "license is \"" + recipe.license + "\", parts of the catalogue are " +
                               std::string(kCatalogueLicense));
  return recipe;
}

std::vector<fs::path> SortedChildren(const fs::path& folder) {
  std::vector<fs::path> children;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    children.push_back(entry.path());
  std::sort(children.begin(), children.end());
  return children;
}

const internal::Family& FamilyOf(const Recipe& recipe, const RecipeFile& file) {
  const internal::Family& family = internal::FamilyNamed(recipe.family, file.recipe.string());
  if (family.role != file.role)
    ThrowRecipeError(file.recipe, "family \"" + recipe.family + "\" builds a " +
                                      std::string(NameOf(family.role)) + ", the folder is for a " +
                                      std::string(NameOf(file.role)));
  return family;
}

CatalogueEntry ReadEntry(const RecipeFile& file) {
  const Recipe recipe = ParseRecipe(ReadFile(file.recipe), file.recipe);
  return {file, FamilyOf(recipe, file).mechanism, recipe.family};
}

void AddRecipes(const fs::path& folder, Category category, PartRole role,
                std::vector<RecipeFile>& recipes) {
  if (!fs::is_directory(folder)) return;
  for (const fs::path& path : SortedChildren(folder)) {
    if (path.extension() == ".yaml")
      recipes.push_back({path.stem().string(), role, category, path});
  }
}

void RequireUniqueIds(const std::vector<RecipeFile>& recipes) {
  std::vector<std::string> ids(recipes.size());
  std::transform(recipes.begin(), recipes.end(), ids.begin(),
                 [](const RecipeFile& file) { return file.id; });
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  if (twice != ids.end())
    throw Error(ErrorCode::kInvalidConfig,
                "the catalogue has two parts with the id \"" + *twice + '"');
}

template <class Entry>
Entry FindById(const std::vector<Entry>& entries, std::string_view id) {
  std::vector<std::string> ids;
  for (const Entry& entry : entries) {
    if (entry.id == id) return entry;
    ids.push_back(entry.id);
  }
  throw Error(ErrorCode::kMissing, "the catalogue has no part \"" + std::string(id) +
                                       "\"; did you mean \"" + NearestName(id, ids) +
                                       "\"? `doorforge catalog list` shows them all");
}

// Recipes are named relative to the catalogue, so that a part does not depend on where it was
// built.
std::string SourceOf(const RecipeFile& file) {
  return "catalog/" + std::string(NameOf(file.category)) + "/" +
         (file.role == PartRole::kBody ? "bodies/" : "handles/") + file.recipe.filename().string();
}

bool ReadsBackTheSame(const RigidTransform& pose, const std::string& path) {
  const nlohmann::ordered_json filed = TransformToJson(pose);
  return TransformToJson(TransformFromJson(filed, path)) == filed;
}

// Reading and writing again moves the last bits, in general towards a pose that stays.
RigidTransform ReadAgain(RigidTransform pose, const std::string& path) {
  constexpr int kMostTimes = 16;
  for (int i = 0; i < kMostTimes && !ReadsBackTheSame(pose, path); ++i)
    pose = TransformFromJson(TransformToJson(pose), path);
  return pose;
}

// A pose that part.json holds to the last bit, so that a part read back equals the part in memory:
// the quaternion is rounded, ever coarser, until it survives becoming a matrix and back.
RigidTransform AsFiled(const RigidTransform& pose, const std::string& path) {
  constexpr int kFinestBits = 52;
  constexpr int kCoarsestBits = 40;
  const Eigen::Quaterniond exact(pose.linear());
  RigidTransform rounded = pose;
  for (int bits = kFinestBits; bits >= kCoarsestBits && !ReadsBackTheSame(rounded, path); --bits) {
    Eigen::Vector4d coefficients = exact.coeffs();
    for (double& value : coefficients)
      value = std::ldexp(std::round(std::ldexp(value, bits)), -bits);
    rounded.linear() = Eigen::Quaterniond(coefficients).normalized().toRotationMatrix();
    rounded = ReadAgain(rounded, path);
  }
  return rounded;
}

}  // namespace

std::vector<RecipeFile> ListRecipes(const fs::path& data_folder) {
  const fs::path catalog = data_folder / "catalog";
  if (!fs::is_directory(catalog))
    throw Error(ErrorCode::kMissing,
                catalog.string() +
                    ": there is no catalogue; set DOORFORGE_DATA to the folder "
                    "that holds catalog/");
  std::vector<RecipeFile> recipes;
  for (const fs::path& folder : SortedChildren(catalog)) {
    if (!fs::is_directory(folder)) continue;
    const auto category = CategoryNamed(folder.filename().string());
    if (!category) ThrowRecipeError(folder, "not a category");
    AddRecipes(folder / "bodies", *category, PartRole::kBody, recipes);
    AddRecipes(folder / "handles", *category, PartRole::kHandle, recipes);
  }
  RequireUniqueIds(recipes);
  std::sort(recipes.begin(), recipes.end(), [](const RecipeFile& a, const RecipeFile& b) {
    return std::tie(a.category, a.role, a.id) < std::tie(b.category, b.role, b.id);
  });
  return recipes;
}

RecipeFile FindRecipe(const std::vector<RecipeFile>& recipes, std::string_view id) {
  return FindById(recipes, id);
}

std::vector<CatalogueEntry> ListCatalogue(const fs::path& data_folder) {
  std::vector<CatalogueEntry> entries;
  for (const RecipeFile& file : ListRecipes(data_folder)) entries.push_back(ReadEntry(file));
  return entries;
}

CatalogueEntry FindCatalogueEntry(const std::vector<CatalogueEntry>& catalogue,
                                  std::string_view id) {
  return FindById(catalogue, id);
}

Part BuildCataloguePart(const RecipeFile& file) {
  const std::string text = ReadFile(file.recipe);
  const Recipe recipe = ParseRecipe(text, file.recipe);
  const internal::Family& family = FamilyOf(recipe, file);
  Part part = family.build(recipe.parameters, file.recipe.string() + ": parameters");
  part.id = recipe.id;
  part.role = family.role;
  part.category = file.category;
  part.mechanism = family.mechanism;
  part.license = recipe.license;
  part.source = SourceOf(file);
  part.source_sha256 = Sha256Hex(text);
  part.part_from_grasp = AsFiled(part.part_from_grasp, part.source);
  part.part_from_mount = AsFiled(part.part_from_mount, part.source);
  return part;
}

Part BuildCataloguePart(const fs::path& data_folder, std::string_view id) {
  return BuildCataloguePart(FindRecipe(ListRecipes(data_folder), id));
}

}  // namespace doorforge
