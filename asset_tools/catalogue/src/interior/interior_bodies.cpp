// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "interior/interior_body.h"

namespace doorforge::internal {
namespace {

struct FlushBody : InteriorBody {
  int grooves_across = 0;   ///< Level grooves, evenly spread.
  int grooves_upright = 0;  ///< Upright grooves, evenly spread.
  double groove_m = 0.004;  ///< Depth, and half the width.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    InteriorBody::VisitFields(self, visit);
    visit("grooves_across", self.grooves_across);
    visit("grooves_upright", self.grooves_upright);
    visit("groove_m", self.groove_m);
  }
};

struct MouldedBody : PanelledBody {
  double moulding_width_m = 0.026;
  double moulding_height_m = 0.009;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    PanelledBody::VisitFields(self, visit);
    visit("moulding_width_m", self.moulding_width_m);
    visit("moulding_height_m", self.moulding_height_m);
  }
};

struct VisionBody : InteriorBody {
  int lites = 1;  ///< Openings one above the other, or side by side.
  bool side_by_side = false;
  double lite_width_m = 0.15;
  double lite_height_m = 0.8;
  double spacing_m = 0.1;  ///< Between openings.
  double center_y = 0.45;  ///< All of them have it, relative to the leaf's width.
  double center_z = 0.62;  ///< All of them have it, relative to the leaf's height.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    InteriorBody::VisitFields(self, visit);
    visit("lites", self.lites);
    visit("side_by_side", self.side_by_side);
    visit("lite_width_m", self.lite_width_m);
    visit("lite_height_m", self.lite_height_m);
    visit("spacing_m", self.spacing_m);
    visit("center_y", self.center_y);
    visit("center_z", self.center_z);
  }
};

struct GlazedBody : InteriorBody {
  double sill_m = 0.85;  ///< Height of the openings' lower edge above the leaf's bottom.
  double stile_width_m = 0.12;
  double top_rail_m = 0.12;
  double muntin_m = 0.028;  ///< Width of the bars between the openings.
  int columns = 2;
  int rows = 2;
  int panels = 1;  ///< Sunk panels below the openings; 0 where the sill is only a rail.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    InteriorBody::VisitFields(self, visit);
    visit("sill_m", self.sill_m);
    visit("stile_width_m", self.stile_width_m);
    visit("top_rail_m", self.top_rail_m);
    visit("muntin_m", self.muntin_m);
    visit("columns", self.columns);
    visit("rows", self.rows);
    visit("panels", self.panels);
  }
};

struct PlankedBody : InteriorBody {
  int planks = 6;
  int ledges = 3;       ///< Boards across the back that hold the planks.
  bool braces = false;  ///< Slanting boards between the ledges, up from the hinge side.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    InteriorBody::VisitFields(self, visit);
    visit("planks", self.planks);
    visit("ledges", self.ledges);
    visit("braces", self.braces);
  }
};

Part BuildFlush(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<FlushBody>(json, path);
  CheckInterior(body, path);
  RequireRange(path, "grooves_across", body.grooves_across, 0, 7);
  RequireRange(path, "grooves_upright", body.grooves_upright, 0, body.grooves_across > 0 ? 0 : 7);
  RequireRange(path, "groove_m", body.groove_m, 0.001, 0.008);
  ReliefSlab slab = FlatSlab(body, LeafOutline(body));
  const double g = body.groove_m;
  const Eigen::Vector2d size = slab.outline.max_m - slab.outline.min_m;
  const auto add = [&](int count, int axis) {
    for (int i = 1; i <= count; ++i) {
      Rectangle area{slab.outline.min_m.array() - 0.02, slab.outline.max_m.array() + 0.02};
      const double at = slab.outline.min_m[axis] + size[axis] * i / (count + 1);
      area.min_m[axis] = at - g;
      area.max_m[axis] = at + g;
      slab.fields.push_back({area, {{0, 0}, {0.2 * g, -g}, {g, -g}}, ReliefSide::kBoth});
    }
  };
  add(body.grooves_across, 1);
  add(body.grooves_upright, 0);
  return InteriorPart(body, ReliefSolid(slab, kInteriorHullToleranceM), path);
}

Part BuildPanelled(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<PanelledBody>(json, path);
  CheckPanelled(body, path);
  const ReliefSlab slab = PanelledSlab(body, LeafOutline(body), path);
  return InteriorPart(body, ReliefSolid(slab, kInteriorHullToleranceM), path);
}

// Mouldings planted on a flat leaf around the fields.
Part BuildMoulded(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<MouldedBody>(json, path);
  CheckPanelled(body, path);
  RequireRange(path, "moulding_width_m", body.moulding_width_m, 0.012, 0.05);
  RequireRange(path, "moulding_height_m", body.moulding_height_m, 0.003, 0.016);
  RequireRange(path, "glazed_rows", body.glazed_rows, 0, 0);
  const double w = body.moulding_width_m;
  const double h = body.moulding_height_m;
  ReliefSlab slab = PanelledSlab(body, LeafOutline(body), path);
  for (ReliefField& field : slab.fields)
    field.profile = {{0, 0},       {0.15 * w, 0.5 * h},  {0.35 * w, h},
                     {0.6 * w, h}, {0.85 * w, 0.35 * h}, {w, 0}};
  return InteriorPart(body, ReliefSolid(slab, 0.5 * kInteriorHullToleranceM + h), path);
}

Part BuildVision(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<VisionBody>(json, path);
  CheckInterior(body, path);
  RequireRange(path, "lites", body.lites, 1, 6);
  RequireRange(path, "lite_width_m", body.lite_width_m, 0.05, 0.5);
  RequireRange(path, "lite_height_m", body.lite_height_m, 0.05, 1.4);
  RequireRange(path, "spacing_m", body.spacing_m, 0.03, 0.4);
  ReliefSlab slab = FlatSlab(body, LeafOutline(body));
  const int axis = body.side_by_side ? 0 : 1;
  const Eigen::Vector2d size(body.lite_width_m, body.lite_height_m);
  Eigen::Vector2d total = size;
  total[axis] += (body.lites - 1) * (size[axis] + body.spacing_m);
  const Eigen::Vector2d leaf = slab.outline.max_m - slab.outline.min_m;
  Eigen::Vector2d low = slab.outline.min_m +
                        Eigen::Vector2d(body.center_y, body.center_z).cwiseProduct(leaf) -
                        total / 2;
  RequireRange(path, "hinge side to openings [m]", low.x(), 0.06, 2);
  RequireRange(path, "openings to free edge [m]", leaf.x() - low.x() - total.x(), 0.12, 2);
  RequireRange(path, "floor to openings [m]", low.y(), 0.1, 2);
  RequireRange(path, "openings to top [m]", slab.outline.max_m.y() - low.y() - total.y(), 0.08, 2);
  for (int i = 0; i < body.lites; ++i) {
    slab.openings.push_back({low, low + size});
    low[axis] += size[axis] + body.spacing_m;
  }
  return InteriorPart(body, ReliefSolid(slab, kInteriorHullToleranceM), path);
}

Part BuildGlazed(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<GlazedBody>(json, path);
  CheckInterior(body, path);
  RequireRange(path, "sill_m", body.sill_m, 0.15, 1.3);
  RequireRange(path, "rows", body.rows, 1, 8);
  RequireRange(path, "panels", body.panels, 0, 3);
  RequireRange(path, "stile_width_m", body.stile_width_m, 0.11, 0.2);
  ReliefSlab slab = FlatSlab(body, LeafOutline(body));
  const FieldGrid lites{body.stile_width_m, body.sill_m,  body.top_rail_m,
                        body.muntin_m,      body.columns, std::vector<double>(body.rows, 1.0)};
  slab.openings = FieldsOf(lites, slab.outline, path);
  if (body.panels > 0) {
    constexpr double kRailM = 0.12;
    const Rectangle below{slab.outline.min_m,
                          {slab.outline.max_m.x(), slab.outline.min_m.y() + body.sill_m}};
    const FieldGrid grid{body.stile_width_m, 1.4 * kRailM, kRailM, 0.1, body.panels, {1.0}};
    for (const Rectangle& field : FieldsOf(grid, below, path))
      slab.fields.push_back({field, RaisedPanel(0.009, 0.002, 0.025), ReliefSide::kBoth});
  }
  return InteriorPart(body, ReliefSolid(slab, kInteriorHullToleranceM), path);
}

constexpr double kLedgeM = 0.12;
constexpr double kLedgeInsetM = 0.05;
constexpr double kLedgeDepthM = 0.022;

// Middles of the ledges from below.
std::vector<double> LedgeHeights(const PlankedBody& body) {
  std::vector<double> heights;
  for (int i = 0; i < body.ledges; ++i) {
    const double along = body.ledges == 1 ? 0.5 : 0.1 + 0.8 * i / (body.ledges - 1);
    heights.push_back(kInteriorFloorGapM + along * body.leaf_height_m);
  }
  return heights;
}

// A slanting board on the back between two ledges, up from the hinge side.
Solid Brace(const PlankedBody& body, double lower_m, double upper_m) {
  const double low = lower_m + kLedgeM / 2 + 0.001;
  const double high = upper_m - kLedgeM / 2 - 0.001;
  const double left = kLedgeInsetM + 0.02;
  const double right = body.leaf_width_m - kLedgeInsetM - 0.02;
  constexpr double kWidthM = 0.11;
  const auto ring = [&](double x) {
    return Ring{
        {x, left, low}, {x, left + kWidthM, low}, {x, right, high}, {x, right - kWidthM, high}};
  };
  const double back = -body.thickness_m;
  return LoftSolid({ring(back - 0.9 * kLedgeDepthM), ring(back)}, 0);
}

Part BuildPlanked(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<PlankedBody>(json, path);
  CheckInterior(body, path);
  RequireRange(path, "planks", body.planks, 2, 10);
  RequireRange(path, "ledges", body.ledges, 0, 4);
  ReliefSlab slab = FlatSlab(body, LeafOutline(body));
  slab.fields = PlankGrooves(slab.outline, body.planks, ReliefSide::kFront);
  const std::vector<double> heights = LedgeHeights(body);
  for (const double z : heights) {
    const Rectangle ledge{{kLedgeInsetM, z - kLedgeM / 2},
                          {body.leaf_width_m - kLedgeInsetM, z + kLedgeM / 2}};
    slab.fields.push_back({ledge,
                           {{0, 0}, {0.0005, kLedgeDepthM - 0.004}, {0.004, kLedgeDepthM}},
                           ReliefSide::kBack});
  }
  std::vector<Solid> solids = {ReliefSolid(slab, kInteriorHullToleranceM)};
  for (std::size_t i = 0; body.braces && i + 1 < heights.size(); ++i)
    solids.push_back(Brace(body, heights[i], heights[i + 1]));
  return InteriorPart(body, Joined(solids), path);
}

}  // namespace

std::span<const Family> InteriorBodyFamilies() {
  static const Family kFamilies[] = {
      {"interior_flush", PartRole::kBody, Mechanism::kNone, BuildFlush},
      {"interior_panelled", PartRole::kBody, Mechanism::kNone, BuildPanelled},
      {"interior_glazed", PartRole::kBody, Mechanism::kNone, BuildGlazed},
      {"interior_planked", PartRole::kBody, Mechanism::kNone, BuildPlanked},
      {"interior_moulded", PartRole::kBody, Mechanism::kNone, BuildMoulded},
      {"interior_vision", PartRole::kBody, Mechanism::kNone, BuildVision},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
