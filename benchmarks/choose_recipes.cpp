// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Which of several draws of each recipe makes the catalogue most diverse.
//
//   choose_recipes FOLDER [ROUNDS]    FOLDER/catalog holds recipes named ID (fixed) or ID--K (draw
//   K
//                                     of recipe ID), as scripts/draw_recipes.py --candidates writes
//
// Draws that cannot be built or that recipe_filter.h refuses are left out, and told about on
// standard error. Recipes take their turn in the order of their names; each takes the draw that
// scores highest against those chosen so far, and further rounds (2 in all if left out) let each
// choose again among all. The score is the distance to the nearest of the others plus the distance
// to the nearest of a random few of them, as many as there are released objects of this category
// and role: the first keeps pairs apart, the second spreads the whole. Distances are Chamfer
// distances as in diversity.cpp, from every 16th point (32nd where there are many recipes); of
// cars, those of the leaves. Prints YAML, ID: K.

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "doorforge/catalogue/catalogue.h"
#include "doorforge/core/error.h"
#include "doorforge/core/parallel_for.h"
#include "doorforge/core/program.h"

#include "part_shapes.h"
#include "recipe_filter.h"

namespace doorforge {
namespace {

constexpr int kStride = 16;
constexpr std::size_t kMany = 100;  // recipes, from which on half of the points do

struct Draw {
  const CatalogueEntry* entry = nullptr;
  PartShape shape;
};

/// A map holds the draws of each recipe, by its id, of one category and role.
using Recipes = std::map<std::string, std::vector<Draw>>;
using Choice = std::map<std::string, const Draw*>;

std::string RecipeOf(const std::string& id) { return id.substr(0, id.find("--")); }
bool IsDraw(const std::string& id) { return id.find("--") != std::string::npos; }

// Released objects of UniDoorManip, without copies.
double ReleasedObjects(const std::string& kind) {
  static const std::map<std::string, double> kCounts = {
      {"interior body", 28},
      {"interior handle", 31},
      {"window body", 7},
      {"window handle", 16},
      {"car body", 7},
      {"car handle", 4},
      {"safe body", 10},
      {"safe handle", 14},
      {"storagefurniture body", 8},
      {"refrigerator body", 6},
      {"refrigerator handle", 5},
      {"storagefurniture handle", 6},
  };
  return kCounts.at(kind);
}

class Chooser {
 public:
  Chooser(const Recipes& recipes, double few)
      : recipes_(recipes), few_(few), stride_(recipes.size() < kMany ? kStride : 2 * kStride) {}

  Choice Choose(int rounds) {
    for (const auto& [recipe, draws] : recipes_) {
      if (!IsDraw(draws.front().shape.id)) chosen_[recipe] = &draws.front();
    }
    for (int round = 0; round < rounds; ++round) {
      for (const auto& [recipe, draws] : recipes_) {
        if (IsDraw(draws.front().shape.id)) chosen_[recipe] = Best(recipe, draws);
      }
    }
    return chosen_;
  }

 private:
  double Score(const Draw& draw, const std::string& recipe) const {
    std::vector<double> distances;
    for (const auto& [name, other] : chosen_) {
      if (name != recipe) distances.push_back(Chamfer(draw.shape, other->shape, stride_));
    }
    if (distances.empty()) return 0;
    std::sort(distances.begin(), distances.end());
    // how likely each is the nearest of a random few
    const double share = std::min(1.0, few_ / static_cast<double>(recipes_.size()));
    double expected = 0;
    double left = 1;
    for (const double distance : distances) {
      expected += left * share * distance;
      left *= 1 - share;
    }
    return distances.front() + expected / (1 - left);
  }

  bool IsSound(const Draw& draw) {
    const auto [found, is_new] = sound_.emplace(draw.shape.id, true);
    if (!is_new) return found->second;
    const std::string fault = SlowFaultOf(BuildCataloguePart(*draw.entry));
    if (!fault.empty()) std::fprintf(stderr, "%s: %s\n", draw.shape.id.c_str(), fault.c_str());
    return found->second = fault.empty();
  }

  const Draw* Best(const std::string& recipe, const std::vector<Draw>& draws) {
    std::vector<std::pair<double, std::size_t>> order(draws.size());
    ParallelFor(draws.size(), 0, [&](std::size_t i) { order[i] = {-Score(draws[i], recipe), i}; });
    std::sort(order.begin(), order.end());
    for (const auto& [score, index] : order) {
      if (IsSound(draws[index])) return &draws[index];
    }
    throw Error(ErrorCode::kInvalidConfig,
                recipe + ": none of its draws keeps to the limits; narrow its family's ranges");
  }

  const Recipes& recipes_;
  double few_;
  int stride_;
  Choice chosen_;
  std::map<std::string, bool> sound_;
};

std::optional<PartShape> Drawn(const CatalogueEntry& entry) {
  try {
    const Part part = BuildCataloguePart(entry);
    const std::string fault = IsDraw(entry.id) ? FaultOf(part) : "";
    if (fault.empty()) {
      const bool leaf = part.category == Category::kCar && part.role == PartRole::kBody;
      PartShape shape = ShapeOf(part, leaf ? "leaf" : "");
      shape.triangles = {};  // only needed for its points
      return shape;
    }
    std::fprintf(stderr, "%s: %s\n", entry.id.c_str(), fault.c_str());
  } catch (const Error& error) {
    std::fprintf(stderr, "%s: %s\n", entry.id.c_str(), error.what());
  }
  return std::nullopt;
}

std::string KindOf(const CatalogueEntry& entry) {
  return std::string(NameOf(entry.category)) + " " + std::string(NameOf(entry.role));
}

std::map<std::string, Recipes> ReadDraws(const std::vector<CatalogueEntry>& entries) {
  std::vector<std::optional<PartShape>> shapes(entries.size());
  ParallelFor(entries.size(), 0, [&](std::size_t i) { shapes[i] = Drawn(entries[i]); });
  std::map<std::string, Recipes> kinds;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    auto& draws = kinds[KindOf(entries[i])][RecipeOf(entries[i].id)];
    if (shapes[i]) draws.push_back({&entries[i], std::move(*shapes[i])});
  }
  return kinds;
}

int Run(int argc, char** argv) {
  Require(argc == 2 || argc == 3, ErrorCode::kInvalidArgument,
          "usage: choose_recipes FOLDER [ROUNDS]");
  const int rounds = argc == 3 ? std::stoi(argv[2]) : 2;
  const std::vector<CatalogueEntry> entries = ListCatalogue(argv[1]);
  std::map<std::string, Recipes> kinds = ReadDraws(entries);
  for (auto& [kind, recipes] : kinds) {
    for (auto& [recipe, draws] : recipes) {
      Require(!draws.empty(), ErrorCode::kInvalidConfig,
              recipe + ": none of its draws keeps to the limits; narrow its family's ranges");
      for (Draw& draw : draws) BuildTree(draw.shape);
    }
    for (const auto& [recipe, draw] : Chooser(recipes, ReleasedObjects(kind)).Choose(rounds)) {
      const std::string& id = draw->shape.id;
      if (IsDraw(id)) std::printf("%s: %s\n", recipe.c_str(), id.c_str() + id.find("--") + 2);
    }
  }
  return 0;
}

}  // namespace
}  // namespace doorforge

int main(int argc, char** argv) {
  return doorforge::RunProgram([&] { return doorforge::Run(argc, argv); });
}
