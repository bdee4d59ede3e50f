// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/error.h"

#include "family.h"
#include "leaf_layout.h"
#include "relief.h"

namespace doorforge::internal {
namespace {

constexpr double kMarginM = 0.003;         // the carcass reaches this far beyond the leaf
constexpr double kLeafToCarcassM = 0.003;  // behind the leaf
constexpr double kLeafToFrontM = 0.006;    // between the leaf and a fixed front beside it
constexpr double kHullToleranceM = 0.006;

/// The box that carries the leaf; stands still.
struct Carcass {
  double depth_m = 0.5;
  double board_m = 0.018;
  int shelves = 1;
  std::string base = "plinth";  ///< "plinth", "legs" or "none".
  double base_height_m = 0.09;
  std::string top = "flush";  ///< "flush", "board" or "cornice".
  double side_width_m = 0;    ///< Width of a bay beside the leaf; 0 for none.
  int side_fronts = 3;        ///< Fixed drawer fronts in that bay.
  std::string finish = "chipboard_white";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("depth_m", self.depth_m);
    visit("board_m", self.board_m);
    visit("shelves", self.shelves);
    visit("base", self.base);
    visit("base_height_m", self.base_height_m);
    visit("top", self.top);
    visit("side_width_m", self.side_width_m);
    visit("side_fronts", self.side_fronts);
    visit("finish", self.finish);
  }
};

/// What all cabinets share.
struct StorageBody {
  double leaf_width_m = 0.56;
  double leaf_height_m = 0.8;
  double thickness_m = 0.02;
  double edge_radius_m = 0.002;
  double mount_height_m = 0.5;     ///< Above the leaf's lower edge.
  double mount_to_edge_m = 0.045;  ///< From the free edge.
  std::string finish = "chipboard_white";
  Carcass carcass;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("leaf_width_m", self.leaf_width_m);
    visit("leaf_height_m", self.leaf_height_m);
    visit("thickness_m", self.thickness_m);
    visit("edge_radius_m", self.edge_radius_m);
    visit("mount_height_m", self.mount_height_m);
    visit("mount_to_edge_m", self.mount_to_edge_m);
    visit("finish", self.finish);
    visit("carcass", self.carcass);
  }
};

struct FramedStorage : StorageBody {
  FieldGrid fields{0.09, 0.09, 0.09, 0.06, 1, {1.0}};
  std::string field = "sunk";  ///< "sunk", "raised" or "open" (right through).
  double panel_depth_m = 0.006;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    StorageBody::VisitFields(self, visit);
    visit("fields", self.fields);
    visit("field", self.field);
    visit("panel_depth_m", self.panel_depth_m);
  }
};

struct PlankedStorage : StorageBody {
  int planks = 5;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    StorageBody::VisitFields(self, visit);
    visit("planks", self.planks);
  }
};

void Check(const StorageBody& body, const std::string& path) {
  RequireRange(path, "leaf_width_m", body.leaf_width_m, 0.5, 1.3);
  RequireRange(path, "leaf_height_m", body.leaf_height_m, 0.45, 1.24);
  RequireRange(path, "thickness_m", body.thickness_m, 0.015, 0.035);
  RequireRange(path, "edge_radius_m", body.edge_radius_m, 0.0005, 0.006);
  RequireRange(path, "mount_height_m", body.mount_height_m, 0.15, body.leaf_height_m - 0.15);
  RequireRange(path, "mount_to_edge_m", body.mount_to_edge_m, 0.038, 0.1);
  const std::string carcass = path + ".carcass";
  RequireRange(carcass, "depth_m", body.carcass.depth_m, 0.28, 0.9);
  RequireRange(carcass, "board_m", body.carcass.board_m, 0.012, 0.035);
  RequireRange(carcass, "shelves", body.carcass.shelves, 0, 4);
  RequireRange(carcass, "base_height_m", body.carcass.base_height_m, 0.03, 0.25);
  if (body.carcass.side_width_m > 0) {
    RequireRange(carcass, "side_width_m", body.carcass.side_width_m, 0.2, 0.8);
    RequireRange(carcass, "side_fronts", body.carcass.side_fronts, 1, 5);
  }
}

double BaseHeight(const Carcass& carcass) {
  return carcass.base == "none" ? 0 : carcass.base_height_m;
}

Rectangle LeafOutline(const StorageBody& body) {
  const double z = BaseHeight(body.carcass) + kMarginM;
  return {{0, z}, {body.leaf_width_m, z + body.leaf_height_m}};
}

// Outline of the whole front.
Rectangle FrontOutline(const StorageBody& body) {
  const Rectangle leaf = LeafOutline(body);
  const double side = body.carcass.side_width_m;
  const double right = leaf.max_m.x() + (side > 0 ? side + kLeafToFrontM : 0);
  return {leaf.min_m.array() - kMarginM, Eigen::Vector2d(right, leaf.max_m.y()).array() + kMarginM};
}

// The box with its shelves: pockets sunk into a block.
Solid CarcassBox(const StorageBody& body) {
  const Carcass& carcass = body.carcass;
  ReliefSlab slab;
  slab.outline = FrontOutline(body);
  slab.thickness_m = carcass.depth_m;
  slab.edge_radius_m = 0.001;
  FieldGrid bays{carcass.board_m, carcass.board_m, carcass.board_m, carcass.board_m, 1, {}};
  bays.rows.assign(static_cast<std::size_t>(carcass.shelves) + 1, 1.0);
  // a shallow draft instead of upright walls keeps the pocket a height field
  const ReliefProfile pocket = SunkPanel(carcass.depth_m - carcass.board_m, 0.0005);
  Rectangle behind_leaf = slab.outline;
  behind_leaf.max_m.x() = body.leaf_width_m + kMarginM;
  for (const Rectangle& bay : FieldsOf(bays, behind_leaf, "carcass"))
    slab.fields.push_back({bay, pocket, ReliefSide::kFront});
  return Moved(ReliefSolid(slab, kHullToleranceM), {-body.thickness_m - kLeafToCarcassM, 0, 0});
}

void AddBase(const StorageBody& body, const std::string& path, std::vector<Solid>& solids) {
  const Carcass& carcass = body.carcass;
  if (carcass.base == "none") return;
  const Rectangle front = FrontOutline(body);
  const double x1 = -body.thickness_m - kLeafToCarcassM;
  const double x0 = x1 - carcass.depth_m;
  const double z = carcass.base_height_m;
  const double y0 = front.min_m.x();
  const double y1 = front.max_m.x();
  if (carcass.base == "plinth") {
    solids.push_back(ChamferedBox({x0 + 0.01, y0 + 0.01, 0}, {x1 - 0.05, y1 - 0.01, z}, 0.002));
    return;
  }
  if (carcass.base != "legs")
    throw Error(ErrorCode::kInvalidConfig,
                path + ".base: found \"" + carcass.base + "\", allowed plinth, legs, none");
  constexpr double kLegM = 0.045;
  for (const double x : {x0 + 0.02, x1 - 0.02 - kLegM}) {
    for (const double y : {y0 + 0.02, y1 - 0.02 - kLegM})
      solids.push_back(ChamferedBox({x, y, 0}, {x + kLegM, y + kLegM, z}, 0.006));
  }
}

void AddTop(const StorageBody& body, const std::string& path, std::vector<Solid>& solids) {
  const std::string& top = body.carcass.top;
  if (top == "flush") return;
  const Rectangle front = FrontOutline(body);
  const double x1 = -body.thickness_m - kLeafToCarcassM;
  const double x0 = x1 - body.carcass.depth_m;
  const double z = front.max_m.y();
  const auto board = [&](double overhang, double from_z, double to_z) {
    solids.push_back(ChamferedBox({x0, front.min_m.x() - overhang, from_z},
                                  {x1 + overhang, front.max_m.x() + overhang, to_z}, 0.004));
  };
  if (top == "board") {
    board(0.015, z, z + 0.026);
  } else if (top == "cornice") {
    board(0.012, z, z + 0.02);
    board(0.03, z + 0.02, z + 0.045);
  } else {
    throw Error(ErrorCode::kInvalidConfig,
                path + ".top: found \"" + top + "\", allowed flush, board, cornice");
  }
}

// Drawer fronts that do not move, beside the leaf.
void AddSideFronts(const StorageBody& body, std::vector<Solid>& solids) {
  if (body.carcass.side_width_m <= 0) return;
  const Rectangle leaf = LeafOutline(body);
  const int count = body.carcass.side_fronts;
  const double gap = 0.004;
  const double height = (body.leaf_height_m - gap * (count - 1)) / count;
  for (int i = 0; i < count; ++i) {
    const double y = leaf.max_m.x() + kLeafToFrontM;
    const double z = leaf.min_m.y() + i * (height + gap);
    ReliefSlab slab;
    slab.outline = {{y, z}, {y + body.carcass.side_width_m, z + height}};
    slab.thickness_m = body.thickness_m;
    slab.edge_radius_m = body.edge_radius_m;
    const Rectangle field{slab.outline.min_m.array() + 0.045, slab.outline.max_m.array() - 0.045};
    slab.fields = {{field, SunkPanel(0.005, 0.003), ReliefSide::kFront}};
    solids.push_back(ReliefSolid(slab, kHullToleranceM));
  }
}

Part BodyPart(const StorageBody& body, const std::string& path, const ReliefSlab& leaf) {
  Part part;
  part.joint = BodyHinge(0);
  std::vector<Solid> solids = {CarcassBox(body)};
  AddBase(body, path + ".carcass", solids);
  AddTop(body, path + ".carcass", solids);
  AddSideFronts(body, solids);
  part.pieces.push_back(
      MakePiece("frame", Joined(solids), body.carcass.finish, path + ".carcass.finish"));
  part.pieces.push_back(
      MakePiece("leaf", ReliefSolid(leaf, kHullToleranceM), body.finish, path + ".finish"));
  part.part_from_mount = Translation(
      {0, body.leaf_width_m - body.mount_to_edge_m, leaf.outline.min_m.y() + body.mount_height_m});
  return part;
}

ReliefSlab SlabOf(const StorageBody& body) {
  ReliefSlab slab;
  slab.outline = LeafOutline(body);
  slab.thickness_m = body.thickness_m;
  slab.edge_radius_m = body.edge_radius_m;
  return slab;
}

Part BuildSlab(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<StorageBody>(json, path);
  Check(body, path);
  return BodyPart(body, path, SlabOf(body));
}

Part BuildFramed(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<FramedStorage>(json, path);
  Check(body, path);
  RequireRange(path, "panel_depth_m", body.panel_depth_m, 0.002, 0.4 * body.thickness_m);
  ReliefSlab slab = SlabOf(body);
  const std::vector<Rectangle> fields = FieldsOf(body.fields, slab.outline, path + ".fields");
  if (body.field == "open") {
    slab.openings = fields;
  } else if (body.field == "sunk" || body.field == "raised") {
    const double depth = body.panel_depth_m;
    const ReliefProfile profile =
        body.field == "sunk" ? SunkPanel(depth, 0.003) : RaisedPanel(depth, 0.2 * depth, 0.025);
    for (const Rectangle& field : fields)
      slab.fields.push_back({field, profile, ReliefSide::kFront});
  } else {
    throw Error(ErrorCode::kInvalidConfig,
                path + ".field: found \"" + body.field + "\", allowed sunk, raised, open");
  }
  return BodyPart(body, path, slab);
}

Part BuildPlanked(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<PlankedStorage>(json, path);
  Check(body, path);
  RequireRange(path, "planks", body.planks, 2, 10);
  ReliefSlab slab = SlabOf(body);
  slab.fields = PlankGrooves(slab.outline, body.planks, ReliefSide::kFront);
  return BodyPart(body, path, slab);
}

}  // namespace

std::span<const Family> StorageBodyFamilies() {
  static const Family kFamilies[] = {
      {"storage_slab", PartRole::kBody, Mechanism::kNone, BuildSlab},
      {"storage_framed", PartRole::kBody, Mechanism::kNone, BuildFramed},
      {"storage_planked", PartRole::kBody, Mechanism::kNone, BuildPlanked},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
