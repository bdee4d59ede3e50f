// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/solids/prism.h"
#include "doorforge/solids/relief.h"

namespace doorforge::internal {

/// A part of a cabinet's front beside, below or above the leaf.
struct Bay {
  std::string kind =
      "none";           ///< "none", "drawers", "doors", "niche" (open), "grid" (open, halved).
  double size_m = 0.4;  ///< Width of a bay beside the leaf, height of one below or above.
  /// Beside the leaf: drawers, doors or compartments on top of each other. Below and above: side by
  /// side.
  int count = 3;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("kind", self.kind);
    visit("size_m", self.size_m);
    visit("count", self.count);
  }
};

/// The box that carries the leaf; stands still. Built from boards with a real cavity.
struct Carcass {
  double depth_m = 0.5;
  double board_m = 0.018;
  int shelves = 1;           ///< Behind the leaf.
  double shelf_depth = 1;    ///< Share of the room's depth, from the back.
  double shelf_grading = 1;  ///< The i-th of n shelves is (i / (n + 1))^grading of the leaf high.
  int dividers = 0;          ///< Upright boards behind the leaf, below the lowest shelf.
  /// "panel", "open" (posts with rails), "slatted"; of a box only.
  std::string sides = "panel";
  bool back = true;  ///< Whether a board closes the back of a box.
  /// Plan: "box", "corner" (sides at 45 degrees and a right angle behind), "tapered" (narrower
  /// behind by `form_m` a side), "flared" (wider behind), "rounded" (sides run back in an arc).
  std::string form = "box";
  double form_m = 0.1;
  /// "plinth", "legs", "tapered", "buns", "sled", "feet", "stand" (legs with a shelf), "panels"
  /// (one at each end), "trestle", "pedestal", "none".
  std::string base = "plinth";
  double base_height_m = 0.09;
  /// "flush", "board", "cornice", "gallery" (upstand at the back and the sides), "slope" (rises to
  /// the back), "pediment", "hutch" (open shelves on top), "mirror" (an upright panel at the back),
  /// "rail" (a low railing), "barrel" (rises to an arch).
  std::string top = "flush";
  double top_height_m = 0.2;  ///< All but flush, board and cornice have it.
  Bay left, right, below, above;
  std::string fronts = "sunk";  ///< Drawers and doors that do not move look so: "plain", "sunk".
  std::string finish = "chipboard_white";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("depth_m", self.depth_m);
    visit("board_m", self.board_m);
    visit("shelves", self.shelves);
    visit("shelf_depth", self.shelf_depth);
    visit("shelf_grading", self.shelf_grading);
    visit("dividers", self.dividers);
    visit("sides", self.sides);
    visit("back", self.back);
    visit("form", self.form);
    visit("form_m", self.form_m);
    visit("base", self.base);
    visit("base_height_m", self.base_height_m);
    visit("top", self.top);
    visit("top_height_m", self.top_height_m);
    visit("left", self.left);
    visit("right", self.right);
    visit("below", self.below);
    visit("above", self.above);
    visit("fronts", self.fronts);
    visit("finish", self.finish);
  }
};

/// The leaf as the carcass sees it.
struct CarcassLeaf {
  double width_m;
  double height_m;
  double front_x_m = 0;  ///< The fronts beside it lie here.
  double thickness_m;    ///< These fronts are so thick; the carcass begins 3 mm behind them.
};

/// Throws Error(kInvalidConfig) on values out of range; `path` names the carcass.
void CheckCarcass(const Carcass& carcass, const std::string& path);

/// Where the leaf hangs, y from 0: above base and lower bay.
Rectangle LeafOutline(const Carcass& carcass, const CarcassLeaf& leaf);

/// At most 32 hulls for the bays and boards that CheckCarcass() admits.
Solid CarcassSolid(const Carcass& carcass, const CarcassLeaf& leaf);

}  // namespace doorforge::internal
