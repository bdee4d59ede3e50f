// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/parts/piece_density.h"

namespace doorforge::internal {
namespace {

// Scanned meshes say nothing about what is inside: a leaf may be hollow, and a repaired sheet is
// thicker than the sheet. So the density is that of a usual construction over its outline, and the
// mass is held within what such leaves weigh.
PieceDensity LeafDensity(Category category) {
  switch (category) {
    case Category::kInterior:
      return {350, 8, 30};
    case Category::kWindow:
      return {500, 4, 25};
    case Category::kCar:
      return {150, 10, 25};
    case Category::kSafe:
      return {1500, 3, 25};
    case Category::kStorageFurniture:
      return {600, 1.5, 15};
    case Category::kRefrigerator:
      return {150, 3, 20};
  }
  return {350, 8, 30};
}

}  // namespace

PieceDensity DensityOf(Category category, std::string_view piece) {
  if (piece == "leaf") return LeafDensity(category);
  if (piece == "frame") return {500, 1, 200};
  // zinc and aluminium castings, in part hollow
  return {2700, 0.05, 1.5};
}

}  // namespace doorforge::internal
