// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "doorforge/schemas/names.h"

namespace doorforge::internal {

/// A category that nobody stated, and why.
struct GuessedCategory {
  Category category = Category::kInterior;
  std::string why;  ///< `the name "kitchen_cabinet"`, `its height of 2.1 m`.
};

/// The first of the names that has a word for a category in it: "fridge", "window", "safe", "car",
/// "cabinet" and their like, and last "door" and "gate". Words are told apart by case and by what
/// is no letter, so that a "cart" is no "car". Nothing where no name tells.
std::optional<GuessedCategory> CategoryByName(std::span<const std::string> names);

/// Taller than 1.5 m stands for a room's door, lower for furniture.
GuessedCategory CategoryByHeight(double height_m);

/// "assumed: category interior, by the name "door"; --category says another".
std::string GuessText(const GuessedCategory& guess);

}  // namespace doorforge::internal
