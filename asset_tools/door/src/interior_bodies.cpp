// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "doorforge/core/error.h"

#include "family.h"
#include "leaf_layout.h"
#include "relief.h"

namespace doorforge::internal {
namespace {

constexpr double kGapM = 0.004;         // between leaf and jamb
constexpr double kFloorGapM = 0.006;    // under the leaf
constexpr double kRevealM = 0.009;      // the casing stands back from the jamb's edge
constexpr double kJambM = 0.03;         // thickness of the jamb's board
constexpr double kStopM = 0.012;        // how far the stop reaches behind the leaf
constexpr double kStopLengthM = 0.03;   // of the stop, along x
constexpr double kMountHeightM = 0.8;   // UniDoorManip: 0.8 m above the leaf's bottom
constexpr double kMountToEdgeM = 0.08;  // and 8 cm from its free edge
constexpr double kHullToleranceM = 0.006;

/// The jambs and the head around the leaf, with casings on both sides of the wall.
struct DoorFrame {
  double casing_width_m = 0.065;
  double casing_depth_m = 0.014;
  double wall_m = 0.11;            ///< Depth of the jamb.
  std::string casing = "rounded";  ///< "flat", "rounded" or "stepped".
  std::string finish = "white_lacquer";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("casing_width_m", self.casing_width_m);
    visit("casing_depth_m", self.casing_depth_m);
    visit("wall_m", self.wall_m);
    visit("casing", self.casing);
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

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    InteriorBody::VisitFields(self, visit);
    visit("fields", self.fields);
    visit("raised", self.raised);
    visit("panel_depth_m", self.panel_depth_m);
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
  int ledges = 3;  ///< Boards across the back that hold the planks.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    InteriorBody::VisitFields(self, visit);
    visit("planks", self.planks);
    visit("ledges", self.ledges);
  }
};

void Check(const InteriorBody& body, const std::string& path) {
  RequireRange(path, "leaf_width_m", body.leaf_width_m, 0.59, 0.97);
  RequireRange(path, "leaf_height_m", body.leaf_height_m, 1.58, 1.85);
  RequireRange(path, "thickness_m", body.thickness_m, 0.03, 0.055);
  RequireRange(path, "edge_radius_m", body.edge_radius_m, 0.0005, 0.008);
  RequireRange(path + ".frame", "casing_width_m", body.frame.casing_width_m, 0.03, 0.12);
  RequireRange(path + ".frame", "casing_depth_m", body.frame.casing_depth_m, 0.006, 0.025);
  RequireRange(path + ".frame", "wall_m", body.frame.wall_m,
               body.thickness_m + kGapM + kStopLengthM + 0.002, 0.25);
}

Rectangle LeafOutline(const InteriorBody& body) {
  return {{0, kFloorGapM}, {body.leaf_width_m, kFloorGapM + body.leaf_height_m}};
}

// The casing's face from its outer to its inner edge, as (distance outwards, height).
std::vector<Eigen::Vector2d> CasingFace(const DoorFrame& frame, const std::string& path) {
  const double width = frame.casing_width_m;
  const double depth = frame.casing_depth_m;
  if (frame.casing == "flat")
    return {{width, depth - 0.002}, {width - 0.002, depth}, {0.002, depth}, {0, depth - 0.002}};
  if (frame.casing == "stepped")
    return {{width, depth - 0.002},      {width - 0.002, depth},      {0.62 * width, depth},
            {0.6 * width, 0.72 * depth}, {0.2 * width, 0.68 * depth}, {0.17 * width, 0.45 * depth},
            {0.002, 0.45 * depth},       {0, 0.45 * depth - 0.002}};
  if (frame.casing == "rounded") {
    std::vector<Eigen::Vector2d> face;
    for (int i = 0; i <= 8; ++i) {
      const double t = i / 8.0;
      face.emplace_back(width * (1 - t), depth * (0.4 + 0.6 * std::sin(0.45 + 2.5 * t)));
    }
    return face;
  }
  throw Error(ErrorCode::kInvalidConfig, path + ".frame.casing: found \"" + frame.casing +
                                             "\", allowed flat, rounded, stepped");
}

// Cross-section of the frame: (u, x) with u outwards from the leaf's gap; counter-clockwise.
std::vector<Eigen::Vector2d> FrameProfile(const InteriorBody& body, const std::string& path) {
  const double back = -body.frame.wall_m;
  const double outer = kRevealM + body.frame.casing_width_m;
  const double stop = -body.thickness_m - kGapM;
  const std::vector<Eigen::Vector2d> face = CasingFace(body.frame, path);
  std::vector<Eigen::Vector2d> profile = {{0, back}, {kRevealM, back}};
  for (auto p = face.rbegin(); p != face.rend(); ++p)
    profile.emplace_back(kRevealM + p->x(), back - p->y());
  profile.insert(profile.end(), {{outer, back}, {kJambM, back}, {kJambM, 0}, {outer, 0}});
  for (const Eigen::Vector2d& p : face) profile.emplace_back(kRevealM + p.x(), p.y());
  profile.insert(profile.end(), {{kRevealM, 0},
                                 {0, 0},
                                 {0, stop},
                                 {-kStopM, stop},
                                 {-kStopM, stop - kStopLengthM},
                                 {0, stop - kStopLengthM}});
  return profile;
}

// A profile up one jamb, along the head and down the other: rings at the floor and the mitres.
std::vector<Ring> AroundLeaf(const InteriorBody& body,
                             const std::vector<Eigen::Vector2d>& profile) {
  const double left = -kGapM;
  const double right = body.leaf_width_m + kGapM;
  const double top = kFloorGapM + body.leaf_height_m + kGapM;
  std::vector<Ring> rings(4);
  for (const Eigen::Vector2d& p : profile) {
    const double u = p.x();
    const double x = p.y();
    rings[0].emplace_back(x, left - u, 0);
    rings[1].emplace_back(x, left - u, top + u);
    rings[2].emplace_back(x, right + u, top + u);
    rings[3].emplace_back(x, right + u, 0);
  }
  return rings;
}

// Boxes of the cross-section, each a mitred prism on every side of the leaf.
std::vector<TriangleMesh> FrameHulls(const InteriorBody& body) {
  const double back = -body.frame.wall_m;
  const double outer = kRevealM + body.frame.casing_width_m;
  const double depth = body.frame.casing_depth_m;
  const double stop = -body.thickness_m - kGapM;
  const std::vector<Rectangle> boxes = {{{0, back}, {kJambM, 0}},
                                        {{-kStopM, stop - kStopLengthM}, {0, stop}},
                                        {{kRevealM, 0}, {outer, depth}},
                                        {{kRevealM, back - depth}, {outer, back}}};
  std::vector<TriangleMesh> hulls;
  for (const Rectangle& box : boxes) {
    const std::vector<Ring> rings = AroundLeaf(
        body,
        {box.min_m, {box.max_m.x(), box.min_m.y()}, box.max_m, {box.min_m.x(), box.max_m.y()}});
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
      const std::vector<TriangleMesh> side = LoftHulls({rings[i], rings[i + 1]}, 0);
      hulls.insert(hulls.end(), side.begin(), side.end());
    }
  }
  return hulls;
}

Part BodyPart(const InteriorBody& body, const std::string& path, const ReliefSlab& leaf) {
  Part part;
  part.joint = BodyHinge(0);
  const std::vector<Eigen::Vector2d> profile = FrameProfile(body, path);
  const Solid frame{LoftProfile(AroundLeaf(body, profile), profile), FrameHulls(body)};
  const double height = body.leaf_height_m;
  const Solid knuckles = HingeKnuckles(part.joint, {0.12 * height, 0.5 * height, 0.88 * height});
  part.pieces.push_back(
      MakePiece("frame", Joined({frame, knuckles}), body.frame.finish, path + ".frame.finish"));
  part.pieces.push_back(
      MakePiece("leaf", ReliefSolid(leaf, kHullToleranceM), body.finish, path + ".finish"));
  part.part_from_mount =
      Translation({0, body.leaf_width_m - kMountToEdgeM, kFloorGapM + kMountHeightM});
  return part;
}

ReliefSlab SlabOf(const InteriorBody& body) {
  ReliefSlab slab;
  slab.outline = LeafOutline(body);
  slab.thickness_m = body.thickness_m;
  slab.edge_radius_m = body.edge_radius_m;
  return slab;
}

Part BuildFlush(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<InteriorBody>(json, path);
  Check(body, path);
  return BodyPart(body, path, SlabOf(body));
}

Part BuildPanelled(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<PanelledBody>(json, path);
  Check(body, path);
  RequireRange(path, "panel_depth_m", body.panel_depth_m, 0.003, 0.35 * body.thickness_m);
  RequireRange(path + ".fields", "stile_width_m", body.fields.stile_width_m, 0.11, 0.2);
  ReliefSlab slab = SlabOf(body);
  const double depth = body.panel_depth_m;
  const ReliefProfile profile =
      body.raised ? RaisedPanel(depth, 0.25 * depth, 0.03) : SunkPanel(depth, 0.004);
  for (const Rectangle& field : FieldsOf(body.fields, slab.outline, path + ".fields")) {
    const double widest = (field.max_m - field.min_m).minCoeff() / 2;
    RequireRange(path, "half width of a field [m]", widest, profile.back().distance_m + 0.002, 2);
    slab.fields.push_back({field, profile, ReliefSide::kBoth});
  }
  return BodyPart(body, path, slab);
}

Part BuildGlazed(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<GlazedBody>(json, path);
  Check(body, path);
  RequireRange(path, "sill_m", body.sill_m, 0.15, 1.3);
  RequireRange(path, "rows", body.rows, 1, 8);
  RequireRange(path, "panels", body.panels, 0, 3);
  RequireRange(path, "stile_width_m", body.stile_width_m, 0.11, 0.2);
  ReliefSlab slab = SlabOf(body);
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
  return BodyPart(body, path, slab);
}

Part BuildPlanked(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<PlankedBody>(json, path);
  Check(body, path);
  RequireRange(path, "planks", body.planks, 2, 10);
  RequireRange(path, "ledges", body.ledges, 0, 4);
  ReliefSlab slab = SlabOf(body);
  slab.fields = PlankGrooves(slab.outline, body.planks, ReliefSide::kFront);
  constexpr double kLedgeM = 0.12;
  constexpr double kInsetM = 0.05;
  for (int i = 0; i < body.ledges; ++i) {
    const double along = body.ledges == 1 ? 0.5 : 0.1 + 0.8 * i / (body.ledges - 1);
    const double z = slab.outline.min_m.y() + along * body.leaf_height_m;
    const Rectangle ledge{{kInsetM, z - kLedgeM / 2},
                          {body.leaf_width_m - kInsetM, z + kLedgeM / 2}};
    slab.fields.push_back({ledge, {{0, 0}, {0.0005, 0.018}, {0.004, 0.022}}, ReliefSide::kBack});
  }
  return BodyPart(body, path, slab);
}

}  // namespace

std::span<const Family> InteriorBodyFamilies() {
  static const Family kFamilies[] = {
      {"interior_flush", PartRole::kBody, Mechanism::kNone, BuildFlush},
      {"interior_panelled", PartRole::kBody, Mechanism::kNone, BuildPanelled},
      {"interior_glazed", PartRole::kBody, Mechanism::kNone, BuildGlazed},
      {"interior_planked", PartRole::kBody, Mechanism::kNone, BuildPlanked},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
