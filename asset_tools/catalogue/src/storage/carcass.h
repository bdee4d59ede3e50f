// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "doorforge/core/named_enum.h"
#include "doorforge/solids/prism.h"
#include "doorforge/solids/relief.h"

namespace doorforge::internal {

/// What a bay of a cabinet holds.
enum class BayKind {
  kNone,  ///< There is no bay.
  kDrawers,
  kDoors,
  kNiche,  ///< It is open.
  kGrid,   ///< It is open, and halved.
};
inline constexpr NamedValue<BayKind> kBayKindWords[] = {{BayKind::kNone, "none"},
                                                        {BayKind::kDrawers, "drawers"},
                                                        {BayKind::kDoors, "doors"},
                                                        {BayKind::kNiche, "niche"},
                                                        {BayKind::kGrid, "grid"}};
constexpr std::span<const NamedValue<BayKind>> ValuesOf(BayKind) { return kBayKindWords; }

/// A part of a cabinet's front beside, below or above the leaf.
struct Bay {
  BayKind kind = BayKind::kNone;
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

/// Sides of a cabinet; all but panels want a box.
enum class CarcassSides {
  kPanel,
  kOpen,  ///< Posts have rails between them.
  kSlatted,
};
inline constexpr NamedValue<CarcassSides> kCarcassSidesWords[] = {
    {CarcassSides::kPanel, "panel"},
    {CarcassSides::kOpen, "open"},
    {CarcassSides::kSlatted, "slatted"}};
constexpr std::span<const NamedValue<CarcassSides>> ValuesOf(CarcassSides) {
  return kCarcassSidesWords;
}

/// Plan of a cabinet.
enum class CarcassForm {
  kBox,
  kCorner,   ///< Its sides run at 45 degrees to a right angle behind.
  kTapered,  ///< It is narrower behind by `form_m` a side.
  kFlared,   ///< It is wider behind.
  kRounded,  ///< Its sides run back in an arc.
};
inline constexpr NamedValue<CarcassForm> kCarcassFormWords[] = {{CarcassForm::kBox, "box"},
                                                                {CarcassForm::kCorner, "corner"},
                                                                {CarcassForm::kTapered, "tapered"},
                                                                {CarcassForm::kFlared, "flared"},
                                                                {CarcassForm::kRounded, "rounded"}};
constexpr std::span<const NamedValue<CarcassForm>> ValuesOf(CarcassForm) {
  return kCarcassFormWords;
}

/// What a cabinet stands on.
enum class CarcassBase {
  kPlinth,
  kLegs,
  kTapered,  ///< They are legs.
  kBuns,
  kSled,
  kFeet,
  kStand,   ///< Legs have a shelf between them.
  kPanels,  ///< One is at each end.
  kTrestle,
  kPedestal,
  kNone,
};
inline constexpr NamedValue<CarcassBase> kCarcassBaseWords[] = {
    {CarcassBase::kPlinth, "plinth"},   {CarcassBase::kLegs, "legs"},
    {CarcassBase::kTapered, "tapered"}, {CarcassBase::kBuns, "buns"},
    {CarcassBase::kSled, "sled"},       {CarcassBase::kFeet, "feet"},
    {CarcassBase::kStand, "stand"},     {CarcassBase::kPanels, "panels"},
    {CarcassBase::kTrestle, "trestle"}, {CarcassBase::kPedestal, "pedestal"},
    {CarcassBase::kNone, "none"}};
constexpr std::span<const NamedValue<CarcassBase>> ValuesOf(CarcassBase) {
  return kCarcassBaseWords;
}

/// What a cabinet has on top.
enum class CarcassTop {
  kFlush,
  kBoard,
  kCornice,
  kGallery,  ///< An upstand is at the back and the sides.
  kSlope,    ///< It rises to the back.
  kPediment,
  kHutch,   ///< It is open shelves.
  kMirror,  ///< It is an upright panel at the back.
  kRail,    ///< It is a low railing.
  kBarrel,  ///< It rises to an arch.
};
inline constexpr NamedValue<CarcassTop> kCarcassTopWords[] = {
    {CarcassTop::kFlush, "flush"},     {CarcassTop::kBoard, "board"},
    {CarcassTop::kCornice, "cornice"}, {CarcassTop::kGallery, "gallery"},
    {CarcassTop::kSlope, "slope"},     {CarcassTop::kPediment, "pediment"},
    {CarcassTop::kHutch, "hutch"},     {CarcassTop::kMirror, "mirror"},
    {CarcassTop::kRail, "rail"},       {CarcassTop::kBarrel, "barrel"}};
constexpr std::span<const NamedValue<CarcassTop>> ValuesOf(CarcassTop) { return kCarcassTopWords; }

/// How drawers and doors that do not move look.
enum class CarcassFronts {
  kPlain,
  kSunk,
};
inline constexpr NamedValue<CarcassFronts> kCarcassFrontsWords[] = {
    {CarcassFronts::kPlain, "plain"}, {CarcassFronts::kSunk, "sunk"}};
constexpr std::span<const NamedValue<CarcassFronts>> ValuesOf(CarcassFronts) {
  return kCarcassFrontsWords;
}

/// The box that carries the leaf; stands still. Built from boards with a real cavity.
struct Carcass {
  double depth_m = 0.5;
  double board_m = 0.018;
  int shelves = 1;           ///< Behind the leaf.
  double shelf_depth = 1;    ///< Share of the room's depth, from the back.
  double shelf_grading = 1;  ///< The i-th of n shelves is (i / (n + 1))^grading of the leaf high.
  int dividers = 0;          ///< Upright boards behind the leaf, below the lowest shelf.
  CarcassSides sides = CarcassSides::kPanel;
  bool back = true;  ///< Whether a board closes the back of a box.
  CarcassForm form = CarcassForm::kBox;
  double form_m = 0.1;
  CarcassBase base = CarcassBase::kPlinth;
  double base_height_m = 0.09;
  CarcassTop top = CarcassTop::kFlush;
  double top_height_m = 0.2;  ///< All but flush, board and cornice have it.
  Bay left, right, below, above;
  CarcassFronts fronts = CarcassFronts::kSunk;
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
