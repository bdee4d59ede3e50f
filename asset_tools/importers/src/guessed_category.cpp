// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "guessed_category.h"

#include <cctype>
#include <iomanip>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

namespace doorforge::internal {
namespace {

struct CategoryWords {
  Category category;
  std::set<std::string> words;
};

// In the order in which they tell: a cabinet has doors, too.
const std::vector<CategoryWords>& KnownCategories() {
  static const std::vector<CategoryWords> words = {
      {Category::kRefrigerator, {"fridge", "refrigerator", "freezer"}},
      {Category::kWindow, {"window", "casement"}},
      {Category::kSafe, {"safe", "vault", "strongbox"}},
      {Category::kCar, {"car", "vehicle", "truck", "pickup", "van"}},
      {Category::kStorageFurniture,
       {"cabinet",    "cupboard", "wardrobe",  "dresser",   "closet",   "locker",    "drawer",
        "drawers",    "shelf",    "sideboard", "furniture", "kitchen",  "microwave", "oven",
        "dishwasher", "washer",   "cabinets",  "storage",   "bookcase", "nightstand"}},
      {Category::kInterior, {"door", "gate", "doorway"}}};
  return words;
}

// "KitchenCabinet_2" is "kitchen" and "cabinet".
std::vector<std::string> TokensOf(const std::string& name) {
  std::vector<std::string> tokens;
  std::string token;
  const auto end = [&] {
    if (!token.empty()) tokens.push_back(std::exchange(token, {}));
  };
  bool was_lower = false;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalpha(byte) == 0 || (std::isupper(byte) != 0 && was_lower)) end();
    if (std::isalpha(byte) != 0) token += static_cast<char>(std::tolower(byte));
    was_lower = std::islower(byte) != 0;
  }
  end();
  return tokens;
}

}  // namespace

std::optional<GuessedCategory> CategoryByName(std::span<const std::string> names) {
  for (const CategoryWords& known : KnownCategories()) {
    for (const std::string& name : names) {
      for (const std::string& token : TokensOf(name)) {
        if (known.words.contains(token))
          return GuessedCategory{known.category, "the name \"" + name + '"'};
      }
    }
  }
  return std::nullopt;
}

GuessedCategory CategoryByHeight(double height_m) {
  constexpr double kRoomDoorM = 1.5;
  std::ostringstream why;
  why << "its height of " << std::setprecision(3) << height_m << " m";
  return {height_m > kRoomDoorM ? Category::kInterior : Category::kStorageFurniture, why.str()};
}

std::string GuessText(const GuessedCategory& guess) {
  return "assumed: category " + std::string(NameOf(guess.category)) + ", by " + guess.why +
         "; --category says another";
}

}  // namespace doorforge::internal
