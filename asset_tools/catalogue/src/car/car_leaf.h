// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/solids/panel_grid.h"

namespace doorforge::internal {

/// A car's curved door leaf: y from its hinge edge at 0 to the free edge, z above the ground. Above
/// the belt line a frame around the window leans inwards and, at both ends, towards the middle.
struct CarLeafShape {
  double length_m = 1.05;       ///< Along y, below the belt line.
  double sill_m = 0.3;          ///< Height of the lower edge.
  double belt_m = 0.92;         ///< Height of the window's lower edge.
  double roof_m = 1.36;         ///< Height of the upper edge; 0: no window frame.
  double front_slope_m = 0.4;   ///< The window frame's front end leans back by this much.
  double rear_slope_m = 0.1;    ///< And its rear end forward.
  double tumblehome_m = 0.14;   ///< Inward lean of the window frame.
  double tuck_m = 0.04;         ///< Inward curve from the widest line down to the lower edge.
  double bow_m = 0.01;          ///< Bulge along y.
  double wheel_cut_m = 0.0;     ///< The lower rear corner is cut back along the wheel by this much.
  double crease_m = 0.006;      ///< Height of the line pressed into the skin below the handle.
  double thickness_m = 0.075;   ///< Below the belt line.
  double frame_width_m = 0.06;  ///< The window frame is so wide.
  double quarter_m = 0;         ///< Not 0: length of a small light in front, behind a bar.
  bool blind = false;           ///< No window in the frame: the side of a panel van.
  double mirror_m = 0;          ///< Not 0: height of the mirror's housing in front of the window.
  double mirror_reach_m = 0.2;  ///< How far it stands out.
  double armrest_m = 0;         ///< Not 0: how far an armrest stands out inside.
  double pocket_m = 0;          ///< A pocket below it is so large.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("length_m", self.length_m);
    visit("sill_m", self.sill_m);
    visit("belt_m", self.belt_m);
    visit("roof_m", self.roof_m);
    visit("front_slope_m", self.front_slope_m);
    visit("rear_slope_m", self.rear_slope_m);
    visit("tumblehome_m", self.tumblehome_m);
    visit("tuck_m", self.tuck_m);
    visit("bow_m", self.bow_m);
    visit("wheel_cut_m", self.wheel_cut_m);
    visit("crease_m", self.crease_m);
    visit("thickness_m", self.thickness_m);
    visit("frame_width_m", self.frame_width_m);
    visit("quarter_m", self.quarter_m);
    visit("blind", self.blind);
    visit("mirror_m", self.mirror_m);
    visit("mirror_reach_m", self.mirror_reach_m);
    visit("armrest_m", self.armrest_m);
    visit("pocket_m", self.pocket_m);
  }
};

/// Throws Error(kInvalidConfig) on a number out of range.
void CheckCarLeaf(const CarLeafShape& leaf, const std::string& path);

bool HasWindowFrame(const CarLeafShape& leaf);

/// The skin's x at a height, in the middle of the leaf's length: at most 0, without the crease.
double SkinX(const CarLeafShape& leaf, double z);
/// y of the leaf's two ends at a height.
double FrontEnd(const CarLeafShape& leaf, double z);
double RearEnd(const CarLeafShape& leaf, double z);
/// x of the hinge edge where it stands out most.
double HingeEdgeX(const CarLeafShape& leaf);

Solid CarLeafSolid(const CarLeafShape& leaf);

}  // namespace doorforge::internal
