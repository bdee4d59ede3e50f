// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Which of several draws of each recipe makes the catalogue most diverse.
//
//   choose_recipes FOLDER [ROUNDS]    parts named ID (fixed) or ID--K (draw K of recipe ID)
//
// scripts/draw_recipes.py --candidates writes such recipes and `doorforge catalog build` builds
// them. Recipes take their turn in the order of their names; each takes the draw whose nearest
// neighbour among those chosen so far is farthest (Chamfer distance as in diversity.cpp, from every
// eighth point), and further rounds (2 in all if left out) let each choose again among all. Prints
// YAML, ID: K.

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"

#include "part_shapes.h"

namespace doorforge {
namespace {

constexpr int kStride = 8;

/// Of one category and role: recipe id -> its draws.
using Recipes = std::map<std::string, std::vector<PartShape>>;
using Choice = std::map<std::string, const PartShape*>;

std::string RecipeOf(const std::string& id) { return id.substr(0, id.find("--")); }

double Nearest(const PartShape& shape, const Choice& chosen) {
  double nearest = 1e300;
  for (const auto& [recipe, other] : chosen) {
    if (recipe != RecipeOf(shape.id)) nearest = std::min(nearest, Chamfer(shape, *other, kStride));
  }
  return nearest;
}

const PartShape* Farthest(const std::vector<PartShape>& draws, const Choice& chosen) {
  std::vector<double> nearest(draws.size());
  ParallelFor(draws.size(), 0, [&](std::size_t i) { nearest[i] = Nearest(draws[i], chosen); });
  const auto best = std::max_element(nearest.begin(), nearest.end()) - nearest.begin();
  return &draws[static_cast<std::size_t>(best)];
}

Choice Chosen(const Recipes& recipes, int rounds) {
  Choice chosen;
  for (const auto& [recipe, draws] : recipes) {
    if (draws.size() == 1) chosen[recipe] = &draws.front();
  }
  for (int round = 0; round < rounds; ++round) {
    for (const auto& [recipe, draws] : recipes) {
      if (draws.size() > 1) chosen[recipe] = Farthest(draws, chosen);
    }
  }
  return chosen;
}

int Run(int argc, char** argv) {
  Require(argc == 2 || argc == 3, ErrorCode::kInvalidArgument,
          "usage: choose_recipes FOLDER [ROUNDS]");
  const int rounds = argc == 3 ? std::stoi(argv[2]) : 2;
  std::map<std::string, Recipes> kinds;
  for (const std::filesystem::path& path : PartFolders(argv[1])) {
    const Part part = ReadPart(path);
    const std::string kind =
        std::string(NameOf(part.category)) + " " + std::string(NameOf(part.role));
    kinds[kind][RecipeOf(part.id)].push_back(ShapeOf(part, ""));
  }
  for (auto& [kind, recipes] : kinds) {
    for (auto& [recipe, draws] : recipes) BuildTrees(draws);
    for (const auto& [recipe, shape] : Chosen(recipes, rounds)) {
      const std::size_t mark = shape->id.find("--");
      if (mark != std::string::npos)
        std::printf("%s: %s\n", recipe.c_str(), shape->id.c_str() + mark + 2);
    }
  }
  return 0;
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] { return doorforge::Run(argc, argv); });
}
