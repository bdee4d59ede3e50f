// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>

#include "doorforge/core/named_enum.h"
#include "doorforge/solids/relief.h"

#include "family.h"
#include "leaf_layout.h"

namespace doorforge::internal {

inline constexpr double kInteriorGapM = 0.004;       ///< Between leaf and jamb, or two leaves.
inline constexpr double kInteriorFloorGapM = 0.006;  ///< Under the leaf.
inline constexpr double kInteriorHullToleranceM = 0.006;

/// Cross-section of a casing.
enum class CasingFaceKind {
  kFlat,
  kRounded,
  kStepped,
};
inline constexpr NamedValue<CasingFaceKind> kCasingFaceKindWords[] = {
    {CasingFaceKind::kFlat, "flat"},
    {CasingFaceKind::kRounded, "rounded"},
    {CasingFaceKind::kStepped, "stepped"}};
constexpr std::span<const NamedValue<CasingFaceKind>> ValuesOf(CasingFaceKind) {
  return kCasingFaceKindWords;
}

/// The jambs and the head around the leaf, with casings on both sides of the wall.
struct DoorFrame {
  double casing_width_m = 0.065;
  double casing_depth_m = 0.014;
  double wall_m = 0.11;  ///< Depth of the jamb.
  CasingFaceKind casing = CasingFaceKind::kRounded;
  double cap_m = 0;  ///< Height of a board on top of the head's casings; 0: none.
  std::string finish = "white_lacquer";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("casing_width_m", self.casing_width_m);
    visit("casing_depth_m", self.casing_depth_m);
    visit("wall_m", self.wall_m);
    visit("casing", self.casing);
    visit("cap_m", self.cap_m);
    visit("finish", self.finish);
  }
};

/// What all interior doors share.
struct InteriorBody {
  double leaf_width_m = 0.74;
  double leaf_height_m = 1.72;
  double thickness_m = 0.04;
  double edge_radius_m = 0.003;
  std::string finish = "white_lacquer";
  DoorFrame frame;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("leaf_width_m", self.leaf_width_m);
    visit("leaf_height_m", self.leaf_height_m);
    visit("thickness_m", self.thickness_m);
    visit("edge_radius_m", self.edge_radius_m);
    visit("finish", self.finish);
    visit("frame", self.frame);
  }
};

struct PanelledBody : InteriorBody {
  FieldGrid fields;
  bool raised = true;  ///< Raised fields, else flat ones sunk behind a slope.
  double panel_depth_m = 0.009;
  int glazed_rows = 0;  ///< So many rows from the top are openings right through the leaf.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    InteriorBody::VisitFields(self, visit);
    visit("fields", self.fields);
    visit("raised", self.raised);
    visit("panel_depth_m", self.panel_depth_m);
    visit("glazed_rows", self.glazed_rows);
  }
};

/// A leaf's top edge as an arch: a parabola that falls by `rise_m` from the middle to both sides.
struct Arch {
  double center_y_m = 0;
  double half_width_m = 1;
  double rise_m = 0;  ///< 0: a straight head.

  /// How far the arch lies below its crown at y.
  double DropAt(double y_m) const {
    const double t = (y_m - center_y_m) / half_width_m;
    return rise_m * t * t;
  }
};

/// What the frame goes around, in the plane of the leaf.
struct FrameOpening {
  Rectangle area;  ///< All leaves with the gaps between them.
  Arch arch;
};

/// Throws Error(kInvalidConfig) on a number out of range; `path` names the body.
void CheckInterior(const InteriorBody& body, const std::string& path);
void CheckPanelled(const PanelledBody& body, const std::string& path);

/// The leaf without the frame, from the hinge to the free edge and from the floor gap upwards.
Rectangle LeafOutline(const InteriorBody& body);

/// A flat slab of the body's thickness and edges.
ReliefSlab FlatSlab(const InteriorBody& body, const Rectangle& outline);

/// A slab with the body's fields; rows of openings from the top where it has them.
ReliefSlab PanelledSlab(const PanelledBody& body, const Rectangle& outline,
                        const std::string& path);

/// Jambs, head and casings around an opening. At most 32 hulls together with 3 knuckles.
Solid FrameAround(const InteriorBody& body, const FrameOpening& opening, const std::string& path);

/// The body of a leaf and what belongs to the frame beside jambs and casings (a fixed leaf; may be
/// empty), with hinge and mount.
Part InteriorPart(const InteriorBody& body, const FrameOpening& opening, const Solid& leaf,
                  const Solid& fixed, const std::string& path);

/// InteriorPart() of one leaf under a straight head.
Part InteriorPart(const InteriorBody& body, const Solid& leaf, const std::string& path);

}  // namespace doorforge::internal
