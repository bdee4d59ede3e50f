// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <span>

#include "family.h"
#include "leaf_layout.h"
#include "leaf_styles.h"
#include "storage/carcass.h"

namespace doorforge::internal {
namespace {

constexpr double kStorageHullToleranceM = 0.006;

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

/// What fills the frame of a leaf.
enum class PanelField {
  kSunk,
  kRaised,
  kOpen,  ///< The frame can be looked through.
};
inline constexpr NamedValue<PanelField> kPanelFieldWords[] = {
    {PanelField::kSunk, "sunk"}, {PanelField::kRaised, "raised"}, {PanelField::kOpen, "open"}};
constexpr std::span<const NamedValue<PanelField>> ValuesOf(PanelField) { return kPanelFieldWords; }

struct FramedStorage : StorageBody {
  FieldGrid fields{0.09, 0.09, 0.09, 0.06, 1, {1.0}};
  PanelField field = PanelField::kSunk;
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

/// Leaves with a plain border.
struct BorderedStorage : StorageBody {
  double border_m = 0.09;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    StorageBody::VisitFields(self, visit);
    visit("border_m", self.border_m);
  }
};

struct LouvredStorage : BorderedStorage {
  int slats = 14;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    BorderedStorage::VisitFields(self, visit);
    visit("slats", self.slats);
  }
};

struct BracedStorage : BorderedStorage {
  int panels = 1;
  bool crossed = false;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    BorderedStorage::VisitFields(self, visit);
    visit("panels", self.panels);
    visit("crossed", self.crossed);
  }
};

struct LatticedStorage : BorderedStorage {
  int bars = 7;
  double bar_width_m = 0.014;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    BorderedStorage::VisitFields(self, visit);
    visit("bars", self.bars);
    visit("bar_width_m", self.bar_width_m);
  }
};

struct ArchedStorage : BorderedStorage {
  double rise_m = 0.08;
  bool open = false;  ///< Without the panel behind the arch.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    BorderedStorage::VisitFields(self, visit);
    visit("rise_m", self.rise_m);
    visit("open", self.open);
  }
};

struct BowedStorage : BorderedStorage {
  double bow_m = 0.03;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    BorderedStorage::VisitFields(self, visit);
    visit("bow_m", self.bow_m);
  }
};

struct ReededStorage : BorderedStorage {
  int reeds = 10;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    BorderedStorage::VisitFields(self, visit);
    visit("reeds", self.reeds);
  }
};

struct LockerStorage : StorageBody {
  int slots = 4;  ///< Pressed vents, near the top and near the bottom.
  double slot_width_m = 0.2;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    StorageBody::VisitFields(self, visit);
    visit("slots", self.slots);
    visit("slot_width_m", self.slot_width_m);
  }
};

void Check(const StorageBody& body, const std::string& path) {
  RequireRange(path, "leaf_width_m", body.leaf_width_m, 0.5, 1.35);
  RequireRange(path, "leaf_height_m", body.leaf_height_m, 0.4, 1.24);
  RequireRange(path, "thickness_m", body.thickness_m, 0.015, 0.04);
  RequireRange(path, "edge_radius_m", body.edge_radius_m, 0.0005, 0.006);
  RequireRange(path, "mount_height_m", body.mount_height_m, 0.15, body.leaf_height_m - 0.15);
  RequireRange(path, "mount_to_edge_m", body.mount_to_edge_m, 0.038, 0.1);
  CheckCarcass(body.carcass, path + ".carcass");
}

void CheckBorder(const BorderedStorage& body, const std::string& path) {
  Check(body, path);
  RequireRange(path, "border_m", body.border_m, 0.084, 0.16);
}

CarcassLeaf InCarcass(const StorageBody& body) {
  return {body.leaf_width_m, body.leaf_height_m, 0, body.thickness_m};
}

LeafShape ShapeOf(const BorderedStorage& body) {
  return {LeafOutline(body.carcass, InCarcass(body)), body.thickness_m, body.edge_radius_m,
          body.border_m};
}

Part BodyPart(const StorageBody& body, const std::string& path, const Solid& leaf) {
  Part part;
  part.joint = BodyHinge(0);
  part.pieces.push_back(MakePiece("frame", CarcassSolid(body.carcass, InCarcass(body)),
                                  body.carcass.finish, path + ".carcass.finish"));
  part.pieces.push_back(MakePiece("leaf", leaf, body.finish, path + ".finish"));
  const double lower_edge = LeafOutline(body.carcass, InCarcass(body)).min_m.y();
  part.part_from_mount =
      Translation({0, body.leaf_width_m - body.mount_to_edge_m, lower_edge + body.mount_height_m});
  return part;
}

ReliefSlab SlabOf(const StorageBody& body) {
  ReliefSlab slab;
  slab.outline = LeafOutline(body.carcass, InCarcass(body));
  slab.thickness_m = body.thickness_m;
  slab.edge_radius_m = body.edge_radius_m;
  return slab;
}

Part BuildSlab(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<StorageBody>(json, path);
  Check(body, path);
  return BodyPart(body, path, ReliefSolid(SlabOf(body), kStorageHullToleranceM));
}

Part BuildStorageFramed(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<FramedStorage>(json, path);
  Check(body, path);
  RequireRange(path, "panel_depth_m", body.panel_depth_m, 0.002, 0.4 * body.thickness_m);
  ReliefSlab slab = SlabOf(body);
  const std::vector<Rectangle> fields = FieldsOf(body.fields, slab.outline, path + ".fields");
  if (body.field == PanelField::kOpen) {
    slab.openings = fields;
  } else {
    const double depth = body.panel_depth_m;
    const ReliefProfile profile = body.field == PanelField::kSunk
                                      ? SunkPanel(depth, 0.003)
                                      : RaisedPanel(depth, 0.2 * depth, 0.025);
    for (const Rectangle& field : fields)
      slab.fields.push_back({field, profile, ReliefSide::kFront});
  }
  return BodyPart(body, path, ReliefSolid(slab, kStorageHullToleranceM));
}

Part BuildStoragePlanked(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<PlankedStorage>(json, path);
  Check(body, path);
  RequireRange(path, "planks", body.planks, 2, 10);
  ReliefSlab slab = SlabOf(body);
  slab.fields = PlankGrooves(slab.outline, body.planks, ReliefSide::kFront);
  return BodyPart(body, path, ReliefSolid(slab, kStorageHullToleranceM));
}

Part BuildStorageLouvred(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<LouvredStorage>(json, path);
  CheckBorder(body, path);
  RequireRange(path, "slats", body.slats, 4, 24);
  return BodyPart(body, path, LouvredLeaf(ShapeOf(body), body.slats));
}

Part BuildStorageBraced(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<BracedStorage>(json, path);
  CheckBorder(body, path);
  RequireRange(path, "panels", body.panels, 1, 2);
  return BodyPart(body, path, BracedLeaf(ShapeOf(body), body.panels, body.crossed));
}

Part BuildLatticed(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<LatticedStorage>(json, path);
  CheckBorder(body, path);
  RequireRange(path, "bars", body.bars, 3, 12);
  RequireRange(path, "bar_width_m", body.bar_width_m, 0.006, 0.03);
  return BodyPart(body, path, LatticedLeaf(ShapeOf(body), body.bars, body.bar_width_m));
}

Part BuildStorageArched(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<ArchedStorage>(json, path);
  CheckBorder(body, path);
  RequireRange(path, "rise_m", body.rise_m, 0.02, 0.2);
  return BodyPart(body, path, ArchedLeaf(ShapeOf(body), body.rise_m, body.open));
}

Part BuildBowed(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<BowedStorage>(json, path);
  CheckBorder(body, path);
  RequireRange(path, "bow_m", body.bow_m, 0.01, 0.07);
  return BodyPart(body, path, BowedLeaf(ShapeOf(body), body.bow_m));
}

Part BuildReeded(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<ReededStorage>(json, path);
  CheckBorder(body, path);
  RequireRange(path, "reeds", body.reeds, 3, 20);
  return BodyPart(body, path, ReededLeaf(ShapeOf(body), body.reeds));
}

Part BuildLocker(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<LockerStorage>(json, path);
  Check(body, path);
  RequireRange(path, "slots", body.slots, 1, 6);
  RequireRange(path, "slot_width_m", body.slot_width_m, 0.08, body.leaf_width_m - 0.2);
  ReliefSlab slab = SlabOf(body);
  const double middle = body.leaf_width_m / 2;
  for (int i = 0; i < body.slots; ++i) {
    for (const double z :
         {slab.outline.min_m.y() + 0.06 + 0.024 * i, slab.outline.max_m.y() - 0.06 - 0.024 * i}) {
      const Rectangle slot{{middle - body.slot_width_m / 2, z - 0.006},
                           {middle + body.slot_width_m / 2, z + 0.006}};
      slab.fields.push_back({slot, SunkPanel(0.005, 0.003), ReliefSide::kFront});
    }
  }
  return BodyPart(body, path, ReliefSolid(slab, kStorageHullToleranceM));
}

}  // namespace

std::span<const Family> StorageBodyFamilies() {
  static const Family kFamilies[] = {
      {"storage_slab", PartRole::kBody, Mechanism::kNone, BuildSlab},
      {"storage_framed", PartRole::kBody, Mechanism::kNone, BuildStorageFramed},
      {"storage_planked", PartRole::kBody, Mechanism::kNone, BuildStoragePlanked},
      {"storage_louvred", PartRole::kBody, Mechanism::kNone, BuildStorageLouvred},
      {"storage_braced", PartRole::kBody, Mechanism::kNone, BuildStorageBraced},
      {"storage_latticed", PartRole::kBody, Mechanism::kNone, BuildLatticed},
      {"storage_arched", PartRole::kBody, Mechanism::kNone, BuildStorageArched},
      {"storage_bowed", PartRole::kBody, Mechanism::kNone, BuildBowed},
      {"storage_reeded", PartRole::kBody, Mechanism::kNone, BuildReeded},
      {"storage_locker", PartRole::kBody, Mechanism::kNone, BuildLocker},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
