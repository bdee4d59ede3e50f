// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "doorforge/core/error.h"
#include "doorforge/solids/prism.h"
#include "doorforge/solids/relief.h"
#include "doorforge/solids/sweep.h"

#include "family.h"
#include "leaf_layout.h"

namespace doorforge::internal {
namespace {

constexpr double kSafeHullToleranceM = 0.006;
constexpr double kSafeJointM = 0.0002;  // between solids that touch
constexpr double kHingeAxisM = 0.0075;
constexpr double kHandleRoomM = 0.132;  // half the width of the largest handle

/// Mouldings on a safe's leaf.
enum class SafeFace {
  kPlain,
  kSunk,
  kRaised,
  kFramed,
  kSplit,  ///< One field lies above and one below the handle.
};
inline constexpr NamedValue<SafeFace> kSafeFaceWords[] = {{SafeFace::kPlain, "plain"},
                                                          {SafeFace::kSunk, "sunk"},
                                                          {SafeFace::kRaised, "raised"},
                                                          {SafeFace::kFramed, "framed"},
                                                          {SafeFace::kSplit, "split"}};
constexpr std::span<const NamedValue<SafeFace>> ValuesOf(SafeFace) { return kSafeFaceWords; }

/// Shape of a safe's box, seen from the front.
enum class SafeOutline {
  kBox,
  kArched,     ///< Its top is a flat arch.
  kOctagon,    ///< Its corners are cut.
  kTrapezoid,  ///< It is wider below.
};
inline constexpr NamedValue<SafeOutline> kSafeOutlineWords[] = {
    {SafeOutline::kBox, "box"},
    {SafeOutline::kArched, "arched"},
    {SafeOutline::kOctagon, "octagon"},
    {SafeOutline::kTrapezoid, "trapezoid"}};
constexpr std::span<const NamedValue<SafeOutline>> ValuesOf(SafeOutline) {
  return kSafeOutlineWords;
}

/// What stands on a safe.
enum class SafeTop {
  kNone,
  kHopper,  ///< Deposits go through it.
  kDome,
  kLid,
  kHandle,
};
inline constexpr NamedValue<SafeTop> kSafeTopWords[] = {{SafeTop::kNone, "none"},
                                                        {SafeTop::kHopper, "hopper"},
                                                        {SafeTop::kDome, "dome"},
                                                        {SafeTop::kLid, "lid"},
                                                        {SafeTop::kHandle, "handle"}};
constexpr std::span<const NamedValue<SafeTop>> ValuesOf(SafeTop) { return kSafeTopWords; }

/// What a safe stands on.
enum class SafeBase {
  kFeet,
  kLegs,
  kStand,  ///< Legs have a shelf between them.
  kPlinth,
  kWheels,
  kNone,
};
inline constexpr NamedValue<SafeBase> kSafeBaseWords[] = {
    {SafeBase::kFeet, "feet"},     {SafeBase::kLegs, "legs"},     {SafeBase::kStand, "stand"},
    {SafeBase::kPlinth, "plinth"}, {SafeBase::kWheels, "wheels"}, {SafeBase::kNone, "none"}};
constexpr std::span<const NamedValue<SafeBase>> ValuesOf(SafeBase) { return kSafeBaseWords; }

/// What all safes share: a thick-walled box with a leaf set into its front.
struct SafeBody {
  double leaf_width_m = 0.36;
  double leaf_height_m = 0.4;
  double thickness_m = 0.04;  ///< The leaf has it.
  double wall_m = 0.05;       ///< The box has it around the leaf's opening.
  double depth_m = 0.45;      ///< The box has it.
  double corner_radius_m = 0.012;
  double leaf_mass_kg = 14;     ///< With its filling and bolt work.
  double mount_forward = 0.55;  ///< It is a share of the leaf's width, from the hinge.
  double mount_height = 0.5;    ///< It is a share of the leaf's height.
  SafeFace face = SafeFace::kSunk;
  SafeOutline outline = SafeOutline::kBox;
  double outline_m = 0.05;  ///< Rise of the arch, cut of a corner, lean of a side.
  SafeTop top = SafeTop::kNone;
  int shelves = 1;
  bool till = false;  ///< A locked drawer below the cavity's top.
  SafeBase base = SafeBase::kFeet;
  double base_height_m = 0.04;
  double hinges_apart = 0.64;  ///< It is a share of the leaf's height.
  std::string finish = "sheet_grey";
  std::string leaf_finish = "sheet_grey";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("leaf_width_m", self.leaf_width_m);
    visit("leaf_height_m", self.leaf_height_m);
    visit("thickness_m", self.thickness_m);
    visit("wall_m", self.wall_m);
    visit("depth_m", self.depth_m);
    visit("corner_radius_m", self.corner_radius_m);
    visit("leaf_mass_kg", self.leaf_mass_kg);
    visit("mount_forward", self.mount_forward);
    visit("mount_height", self.mount_height);
    visit("face", self.face);
    visit("outline", self.outline);
    visit("outline_m", self.outline_m);
    visit("top", self.top);
    visit("shelves", self.shelves);
    visit("till", self.till);
    visit("base", self.base);
    visit("base_height_m", self.base_height_m);
    visit("hinges_apart", self.hinges_apart);
    visit("finish", self.finish);
    visit("leaf_finish", self.leaf_finish);
  }
};

struct WallSafe : SafeBody {
  double flange_m = 0.05;  ///< How far the flange stands out beyond the box.
  double flange_thickness_m = 0.012;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    SafeBody::VisitFields(self, visit);
    visit("flange_m", self.flange_m);
    visit("flange_thickness_m", self.flange_thickness_m);
  }
};

struct VaultSafe : SafeBody {
  bool drum = false;       ///< A cylinder instead of a box.
  double collar_m = 0.03;  ///< Width of the ring around the leaf.
  int bolts = 8;           ///< Bosses on the leaf's rim.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    SafeBody::VisitFields(self, visit);
    visit("drum", self.drum);
    visit("collar_m", self.collar_m);
    visit("bolts", self.bolts);
  }
};

/// What the tier beside the leaf holds; none of it opens.
enum class SafeTier {
  kDoor,  ///< It has a dial.
  kDrawers,
  kBoxes,  ///< They are a wall of deposit boxes.
};
inline constexpr NamedValue<SafeTier> kSafeTierWords[] = {
    {SafeTier::kDoor, "door"}, {SafeTier::kDrawers, "drawers"}, {SafeTier::kBoxes, "boxes"}};
constexpr std::span<const NamedValue<SafeTier>> ValuesOf(SafeTier) { return kSafeTierWords; }

struct TieredSafe : SafeBody {
  double tier_m = 0.3;  ///< Height of the other tier.
  bool tier_below = true;
  SafeTier tier = SafeTier::kDoor;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    SafeBody::VisitFields(self, visit);
    visit("tier_m", self.tier_m);
    visit("tier_below", self.tier_below);
    visit("tier", self.tier);
  }
};

struct HotelSafe : SafeBody {
  double panel_m = 0.14;  ///< Width of the fixed panel with the keypad, beside the leaf.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    SafeBody::VisitFields(self, visit);
    visit("panel_m", self.panel_m);
  }
};

struct AntiqueSafe : SafeBody {
  int steps = 3;  ///< The mouldings above and below have so many.
  double step_m = 0.014;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    SafeBody::VisitFields(self, visit);
    visit("steps", self.steps);
    visit("step_m", self.step_m);
  }
};

void Check(const SafeBody& body, const std::string& path) {
  RequireRange(path, "leaf_width_m", body.leaf_width_m, 2 * kHandleRoomM, 0.78);
  RequireRange(path, "leaf_height_m", body.leaf_height_m, 2 * kHandleRoomM, 0.95);
  RequireRange(path, "thickness_m", body.thickness_m, 0.02, 0.08);
  RequireRange(path, "wall_m", body.wall_m, 0.025, 0.14);
  RequireRange(path, "depth_m", body.depth_m, 0.16, 0.92);
  RequireRange(path, "corner_radius_m", body.corner_radius_m, 0.002, 0.06);
  RequireRange(path, "leaf_mass_kg", body.leaf_mass_kg, 5, 40);
  RequireRange(path, "shelves", body.shelves, 0, 3);
  RequireRange(path, "base_height_m", body.base_height_m, 0.015, 0.4);
  RequireRange(path, "outline_m", body.outline_m, 0.01, 0.16);
  RequireRange(path, "hinges_apart", body.hinges_apart, 0.3, 0.75);
  const double across = kHandleRoomM / body.leaf_width_m;
  RequireRange(path, "mount_forward", body.mount_forward, across, 1 - across);
  const double up = kHandleRoomM / body.leaf_height_m;
  RequireRange(path, "mount_height", body.mount_height, up, 1 - up);
}

double BaseHeight(const SafeBody& body) {
  return body.base == SafeBase::kNone ? 0 : body.base_height_m;
}

// The far edge of a leaf that turns about a line in front of it comes out farther than its width.
double Gap(const SafeBody& body) {
  const double deep = body.thickness_m + kHingeAxisM;
  return 0.002 + deep * deep / (2 * body.leaf_width_m);
}

/// Places in (y, z): leaf, its opening, the box around them.
struct SafeLayout {
  Rectangle leaf;
  Rectangle opening;
  Rectangle box;
};

SafeLayout LayoutOf(const SafeBody& body, double below_m, double above_m, double beside_m) {
  const double gap = Gap(body);
  const double z = BaseHeight(body) + body.wall_m + gap + below_m;
  SafeLayout layout;
  layout.leaf = {{0, z}, {body.leaf_width_m, z + body.leaf_height_m}};
  layout.opening = {layout.leaf.min_m.array() - gap, layout.leaf.max_m.array() + gap};
  layout.opening.min_m.x() = -0.003;
  layout.box = {layout.opening.min_m.array() - body.wall_m,
                layout.opening.max_m.array() + body.wall_m};
  layout.box.min_m.y() -= below_m;
  layout.box.max_m += Eigen::Vector2d(beside_m, above_m);
  return layout;
}

Eigen::Vector2d CenterOf(const Rectangle& r) { return (r.min_m + r.max_m) / 2; }

Polygon PolygonOf(const Rectangle& r, double radius_m) {
  return RoundedBoxPolygon(r.min_m, r.max_m, radius_m);
}

// Around the box; what the outline adds lies outside it.
Polygon OuterPolygon(const SafeBody& body, const Rectangle& box, const std::string& path) {
  const double by = body.outline_m;
  const Eigen::Vector2d& low = box.min_m;
  const Eigen::Vector2d& high = box.max_m;
  if (body.outline == SafeOutline::kBox) return PolygonOf(box, body.corner_radius_m);
  if (body.outline == SafeOutline::kTrapezoid)
    return {{low.x() - by, low.y()}, {high.x() + by, low.y()}, high, {low.x(), high.y()}};
  if (body.outline == SafeOutline::kOctagon) {
    RequireRange(path, "outline_m (of an octagon)", by, 0.01, 1.2 * body.wall_m);
    return {{low.x() + by, low.y()},   {high.x() - by, low.y()},  {high.x(), low.y() + by},
            {high.x(), high.y() - by}, {high.x() - by, high.y()}, {low.x() + by, high.y()},
            {low.x(), high.y() - by},  {low.x(), low.y() + by}};
  }
  constexpr int kSteps = 14;
  Polygon arch = {low, {high.x(), low.y()}};
  const double half = (high.x() - low.x()) / 2;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = 1 - 2.0 * i / kSteps;
    arch.emplace_back((low.x() + high.x()) / 2 + half * t, high.y() + by * (1 - t * t));
  }
  return arch;
}

// The box with its cavity; the front is x = front_x.
Solid SafeShell(const SafeBody& body, const SafeLayout& layout, double front_x_m,
                const std::string& path) {
  CupShape cup;
  cup.outer = OuterPolygon(body, layout.box, path);
  cup.inner = BoxPolygon(layout.opening.min_m, layout.opening.max_m);
  cup.outer_hull = cup.outer;
  cup.inner_hull = cup.inner;
  cup.back_x_m = front_x_m - body.depth_m;
  cup.floor_x_m = cup.back_x_m + 0.6 * body.wall_m;
  cup.front_x_m = front_x_m;
  cup.edge_radius_m = std::min(0.006, 0.6 * body.corner_radius_m);
  return CupSolid(cup);
}

void AddShelves(const SafeBody& body, const Rectangle& room, double front_x_m,
                std::vector<Solid>& solids) {
  const double back = front_x_m - body.depth_m + 0.6 * body.wall_m;
  const double front = front_x_m - body.thickness_m - 0.05;
  if (front - back < 0.06) return;
  for (int i = 1; i <= body.shelves; ++i) {
    const double z = room.min_m.y() + (room.max_m.y() - room.min_m.y()) * i / (body.shelves + 1.0);
    solids.push_back(ChamferedBox({back + kSafeJointM, room.min_m.x() + kSafeJointM, z - 0.004},
                                  {front, room.max_m.x() - kSafeJointM, z + 0.004}, 0.001));
  }
  if (body.till)
    solids.push_back(
        ChamferedBox({back + kSafeJointM, room.min_m.x() + 0.03, room.max_m.y() - 0.08},
                     {front + 0.01, room.max_m.x() - 0.03, room.max_m.y() - kSafeJointM}, 0.003));
}

// What stands on a box with a flat top.
void AddTop(const SafeBody& body, const std::string& path, const Rectangle& box, double front_x_m,
            std::vector<Solid>& solids) {
  if (body.top == SafeTop::kNone) return;
  if (body.outline == SafeOutline::kArched)
    throw Error(ErrorCode::kInvalidConfig, path + ".top: found \"" + std::string(NameOf(body.top)) +
                                               "\", allowed none on an arch");
  const double z = box.max_m.y() + kSafeJointM;
  const double x0 = front_x_m - body.depth_m;
  const double y = (box.min_m.x() + box.max_m.x()) / 2;
  const double width = box.max_m.x() - box.min_m.x();
  const double in =
      0.012 + (body.outline == SafeOutline::kOctagon ? body.outline_m : body.corner_radius_m);
  if (body.top == SafeTop::kHopper) {
    const double x1 = front_x_m - 0.2 * body.depth_m;
    const double x_back = x0 + 0.012;
    solids.push_back(ConvexPrism(
        {{z, x_back}, {z + 0.11, x_back}, {z + 0.11, 0.5 * (x_back + x1)}, {z + 0.04, x1}, {z, x1}},
        PrismAxis::kY, {y - 0.36 * width, y + 0.36 * width}, 0.004));
  } else if (body.top == SafeTop::kDome) {
    std::vector<Ring> rings;
    const Eigen::Vector2d low(x0 + 0.012, box.min_m.x() + in);
    const Eigen::Vector2d high(front_x_m - 0.012, box.max_m.x() - in);
    for (const double t : {0.0, 0.3, 0.55, 0.8, 1.0}) {
      Ring ring;
      const double inset = 0.3 * t * t * (high - low).minCoeff();
      for (const Eigen::Vector2d& p :
           RoundedBoxPolygon(low.array() + inset, high.array() - inset, 0.02))
        ring.emplace_back(p.x(), p.y(), z + 0.09 * t);
      rings.push_back(ring);
    }
    solids.push_back(LoftSolid(rings, 0.004));
  } else if (body.top == SafeTop::kLid) {
    solids.push_back(ChamferedBox({x0 - 0.012, box.min_m.x() - 0.015, z},
                                  {front_x_m - 0.004, box.max_m.x() + 0.015, z + 0.03}, 0.006));
  } else {
    const double half = std::min(0.09, 0.3 * width);
    const double x = front_x_m - body.depth_m / 2;
    for (const double side : {-1.0, 1.0})
      solids.push_back(ChamferedBox({x - 0.012, y + side * half - 0.009, z},
                                    {x + 0.012, y + side * half + 0.009, z + 0.05}, 0.002));
    solids.push_back(ChamferedBox({x - 0.012, y - half - 0.009, z + 0.05 + kSafeJointM},
                                  {x + 0.012, y + half + 0.009, z + 0.07}, 0.006));
  }
}

Solid Wheel(const Eigen::Vector3d& center, double radius) {
  Polygon circle = CirclePolygon({center.z(), center.x()}, radius, 20);
  return ConvexPrism(circle, PrismAxis::kY, {center.y() - 0.012, center.y() + 0.012}, 0.002);
}

void AddBase(const SafeBody& body, const Rectangle& box, double front_x_m,
             std::vector<Solid>& solids) {
  if (body.base == SafeBase::kNone) return;
  const double h = body.base_height_m;
  const double x1 = front_x_m - 0.012;
  const double x0 = front_x_m - body.depth_m + 0.012;
  const double y0 = box.min_m.x() + 0.012;
  const double y1 = box.max_m.x() - 0.012;
  if (body.base == SafeBase::kPlinth) {
    solids.push_back(ChamferedBox({x0, y0, 0}, {x1 - 0.02, y1, h - kSafeJointM}, 0.003));
    return;
  }
  const double size = std::min(0.045, 0.3 * (y1 - y0));
  if (body.base == SafeBase::kStand)
    solids.push_back(ChamferedBox({x0 + 0.004, y0 + 0.004, 0.3 * h},
                                  {x1 - 0.004, y1 - 0.004, 0.3 * h + 0.016}, 0.002));
  for (const double x : {x0, x1 - size}) {
    for (const double y : {y0, y1 - size}) {
      const Eigen::Vector3d middle(x + size / 2, y + size / 2, 0);
      if (body.base == SafeBase::kFeet) {
        const Polygon circle = CirclePolygon({middle.x(), middle.y()}, size / 2, 20);
        solids.push_back(ConvexPrism(circle, PrismAxis::kZ, {0, h - kSafeJointM}, 0.004));
      } else if (body.base == SafeBase::kLegs) {
        solids.push_back(ChamferedBox({x, y, 0}, {x + size, y + size, h - kSafeJointM}, 0.006));
      } else if (body.base == SafeBase::kStand) {
        // below and above the shelf
        solids.push_back(
            ChamferedBox({x, y, 0}, {x + size, y + size, 0.3 * h - kSafeJointM}, 0.003));
        solids.push_back(ChamferedBox({x, y, 0.3 * h + 0.016 + kSafeJointM},
                                      {x + size, y + size, h - kSafeJointM}, 0.003));
      } else {
        const double r = std::max(0.012, 0.5 * h - 0.004);
        solids.push_back(Wheel({middle.x(), middle.y(), r}, r));
        solids.push_back(ChamferedBox({x, y, 2 * r + kSafeJointM},
                                      {x + size, y + size, h - kSafeJointM}, 0.001));
      }
    }
  }
}

// Mouldings of a rectangular leaf; the middle stays plain for the handle.
void AddFace(const SafeBody& body, ReliefSlab& slab) {
  const auto inner = [&](double by) {
    return Rectangle{slab.outline.min_m.array() + by, slab.outline.max_m.array() - by};
  };
  if (body.face == SafeFace::kSunk) {
    slab.fields = {{inner(0.022), SunkPanel(0.005, 0.004), ReliefSide::kFront}};
  } else if (body.face == SafeFace::kRaised) {
    slab.fields = {{inner(0.014), {{0, 0}, {0.006, 0.005}}, ReliefSide::kFront}};
  } else if (body.face == SafeFace::kFramed) {
    slab.fields = {
        {inner(0.016), {{0, 0}, {0.003, -0.005}, {0.009, -0.005}, {0.012, 0}}, ReliefSide::kFront}};
  } else if (body.face == SafeFace::kSplit) {
    // two fields, one above and one below the handle
    const Rectangle all = inner(0.02);
    const double z = slab.outline.min_m.y() +
                     body.mount_height * (slab.outline.max_m.y() - slab.outline.min_m.y());
    for (const auto& [low, high] : {std::pair{all.min_m.y(), z - kHandleRoomM + 0.06},
                                    std::pair{z + kHandleRoomM - 0.06, all.max_m.y()}}) {
      if (high - low > 0.03)
        slab.fields.push_back({{{all.min_m.x(), low}, {all.max_m.x(), high}},
                               SunkPanel(0.006, 0.004),
                               ReliefSide::kFront});
    }
  }
}

Solid LeafSolid(const SafeBody& body, const Rectangle& outline) {
  ReliefSlab slab;
  slab.outline = outline;
  slab.thickness_m = body.thickness_m;
  slab.edge_radius_m = 0.003;
  AddFace(body, slab);
  return ReliefSolid(slab, kSafeHullToleranceM);
}

PartPiece WithMass(PartPiece piece, double mass_kg) {
  piece.mass.inertia_kg_m2 *= mass_kg / piece.mass.mass_kg;
  piece.mass.mass_kg = mass_kg;
  return piece;
}

Part SafePart(const SafeBody& body, const std::string& path, const Rectangle& leaf_outline,
              const std::vector<Solid>& frame, const Solid& leaf) {
  Part part;
  part.joint = BodyHinge(0);
  std::vector<Solid> solids = frame;
  const double height = leaf_outline.max_m.y() - leaf_outline.min_m.y();
  solids.push_back(HingeKnuckles(part.joint, {leaf_outline.min_m.y() + 0.18 * height,
                                              leaf_outline.max_m.y() - 0.18 * height}));
  part.pieces.push_back(MakePiece("frame", Joined(solids), body.finish, path + ".finish"));
  part.pieces.push_back(WithMass(MakePiece("leaf", leaf, body.leaf_finish, path + ".leaf_finish"),
                                 body.leaf_mass_kg));
  part.part_from_mount =
      Translation({0, leaf_outline.min_m.x() + body.mount_forward * body.leaf_width_m,
                   leaf_outline.min_m.y() + body.mount_height * height});
  return part;
}

Part BuildSafeBox(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<SafeBody>(json, path);
  Check(body, path);
  const SafeLayout layout = LayoutOf(body, 0, 0, 0);
  std::vector<Solid> frame = {SafeShell(body, layout, 0, path)};
  AddShelves(body, layout.opening, 0, frame);
  AddTop(body, path, layout.box, 0, frame);
  AddBase(body, layout.box, 0, frame);
  return SafePart(body, path, layout.leaf, frame, LeafSolid(body, layout.leaf));
}

Part BuildWall(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<WallSafe>(json, path);
  Check(body, path);
  RequireRange(path, "flange_m", body.flange_m, 0.015, 0.16);
  RequireRange(path, "flange_thickness_m", body.flange_thickness_m, 0.004, 0.03);
  SafeLayout layout = LayoutOf(body, body.flange_m, body.flange_m, 0);
  ReliefSlab flange;
  flange.outline = {layout.box.min_m - Eigen::Vector2d(body.flange_m, 0),
                    layout.box.max_m + Eigen::Vector2d(body.flange_m, 0)};
  flange.openings = {layout.opening};
  flange.thickness_m = body.flange_thickness_m;
  flange.edge_radius_m = 0.4 * body.flange_thickness_m;
  layout.box = {layout.opening.min_m.array() - body.wall_m,
                layout.opening.max_m.array() + body.wall_m};
  const double front = -body.flange_thickness_m - kSafeJointM;
  std::vector<Solid> frame = {ReliefSolid(flange, kSafeHullToleranceM),
                              SafeShell(body, layout, front, path)};
  AddShelves(body, layout.opening, front, frame);
  return SafePart(body, path, layout.leaf, frame, LeafSolid(body, layout.leaf));
}

// A plug that tapers to the back, with a rim of bosses.
Solid RoundLeaf(const VaultSafe& body, const Eigen::Vector2d& center) {
  const double r = body.leaf_width_m / 2;
  const double t = body.thickness_m;
  const double taper = 0.004 + (t + kHingeAxisM) * (t + kHingeAxisM) / (4 * r);
  const auto rings = [&](int points) {
    std::vector<Ring> all;
    for (const auto& [radius, x] : {std::pair{r - taper, -t},
                                    {r - taper + 0.002, -t + 0.002},
                                    {r, -0.35 * t},
                                    {r, -0.004},
                                    {r - 0.004, 0.0}}) {
      Ring ring;
      for (const Eigen::Vector2d& p : CirclePolygon(center, radius, points))
        ring.emplace_back(x, p.x(), p.y());
      all.push_back(ring);
    }
    return all;
  };
  const std::vector<Ring> coarse = rings(20);
  std::vector<Solid> solids = {
      {Loft(rings(48)), LoftHulls({coarse.front(), coarse[2], coarse.back()}, 0.001)}};
  for (int i = 0; i < body.bolts; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / body.bolts;
    const Eigen::Vector2d at =
        center + (r - 0.03) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    solids.push_back(
        ConvexPrism(CirclePolygon(at, 0.011, 12), PrismAxis::kX, {kSafeJointM, 0.007}, 0.002));
  }
  return Joined(solids);
}

Part BuildVault(const nlohmann::ordered_json& json, const std::string& path) {
  auto body = ReadParameters<VaultSafe>(json, path);
  body.leaf_height_m = body.leaf_width_m;
  Check(body, path);
  RequireRange(path, "thickness_m", body.thickness_m, 0.045, 0.08);
  RequireRange(path, "collar_m", body.collar_m, 0.012, 0.6 * body.wall_m);
  RequireRange(path, "bolts", body.bolts, 0, 8);
  const SafeLayout layout = LayoutOf(body, 0, 0, 0);
  const Eigen::Vector2d center = CenterOf(layout.leaf);
  const double opening = body.leaf_width_m / 2 + Gap(body);
  CupShape cup;
  const double reach = opening + body.wall_m;
  const Rectangle square{center.array() - reach, center.array() + reach};
  cup.outer =
      body.drum ? CirclePolygon(center, reach, 48) : PolygonOf(square, body.corner_radius_m);
  cup.outer_hull = body.drum ? CirclePolygon(center, reach * 1.004, 24) : cup.outer;
  cup.inner = CirclePolygon(center, opening, 48);
  // its sides lie 3 mm inside the opening, in the gap around the leaf
  cup.inner_hull = CirclePolygon(center, (opening - 0.003) / std::cos(std::numbers::pi / 12), 12);
  cup.back_x_m = -body.depth_m;
  cup.floor_x_m = -body.depth_m + 0.6 * body.wall_m;
  cup.front_x_m = 0;
  cup.edge_radius_m = body.drum ? 0.006 : std::min(0.006, 0.6 * body.corner_radius_m);
  // the block's hulls reach to the front of the collar, which has none of its own
  const std::vector<TriangleMesh> hulls = CupSolid(cup).hulls;
  cup.front_x_m = -0.007;
  const HoopShape collar{opening + 0.004 + body.collar_m / 2, body.collar_m / 2, 0.0033, 6, 48};
  std::vector<Solid> frame = {{CupSolid(cup).mesh, hulls},
                              {HoopSolid(collar, {-0.0035, center.x(), center.y()}).mesh, {}}};
  AddBase(body, square, 0, frame);
  return SafePart(body, path, layout.leaf, frame, RoundLeaf(body, center));
}

Solid Dial(const Eigen::Vector2d& at, double radius, double x) {
  const LatheShape shape{32, 0.0008, 8};
  return Moved(LatheSolid({{0, radius},
                           {0.004, radius},
                           {0.007, 0.72 * radius},
                           {0.02, 0.62 * radius},
                           {0.022, 0.5 * radius}},
                          shape),
               {x, at.x(), at.y()});
}

// What does not open: a door with a dial, drawers or a wall of deposit boxes.
void AddFixedFronts(SafeTier kind, const Rectangle& area, std::vector<Solid>& solids) {
  const double gap = 0.004;
  const int rows = kind == SafeTier::kDoor ? 1 : 2;
  const int columns = kind == SafeTier::kBoxes ? 3 : 1;
  const Eigen::Vector2d size = area.max_m - area.min_m;
  const Eigen::Vector2d cell((size.x() - gap * (columns - 1)) / columns,
                             (size.y() - gap * (rows - 1)) / rows);
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k < columns; ++k) {
      const Eigen::Vector2d low =
          area.min_m + Eigen::Vector2d(k * (cell.x() + gap), i * (cell.y() + gap));
      ReliefSlab slab;
      slab.outline = {low, low + cell};
      slab.thickness_m = 0.012;
      slab.edge_radius_m = 0.002;
      const double border = 0.12 * std::min(cell.x(), cell.y());
      slab.fields = {{{(low.array() + border).matrix(), (low + cell).array() - border},
                      SunkPanel(0.003, 0.002),
                      ReliefSide::kFront}};
      solids.push_back(Moved(ReliefSolid(slab, kSafeHullToleranceM), {0.012 + kSafeJointM, 0, 0}));
    }
  }
  if (kind == SafeTier::kDoor) solids.push_back(Dial(CenterOf(area), 0.032, 0.0095));
}

Part BuildTiered(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<TieredSafe>(json, path);
  Check(body, path);
  RequireRange(path, "tier_m", body.tier_m, 0.12, 0.5);
  const double more = body.tier_m + body.wall_m;
  const SafeLayout layout =
      LayoutOf(body, body.tier_below ? more : 0, body.tier_below ? 0 : more, 0);
  std::vector<Solid> frame = {SafeShell(body, layout, 0, path)};
  const double z0 =
      body.tier_below ? layout.box.min_m.y() + body.wall_m : layout.opening.max_m.y() + body.wall_m;
  AddFixedFronts(body.tier,
                 {{layout.opening.min_m.x(), z0}, {layout.opening.max_m.x(), z0 + body.tier_m}},
                 frame);
  AddShelves(body, layout.opening, 0, frame);
  AddTop(body, path, layout.box, 0, frame);
  AddBase(body, layout.box, 0, frame);
  return SafePart(body, path, layout.leaf, frame, LeafSolid(body, layout.leaf));
}

Part BuildHotel(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<HotelSafe>(json, path);
  Check(body, path);
  RequireRange(path, "panel_m", body.panel_m, 0.09, 0.3);
  const SafeLayout layout = LayoutOf(body, 0, 0, body.panel_m);
  std::vector<Solid> frame = {SafeShell(body, layout, 0, path)};
  const double y = layout.opening.max_m.x() + body.panel_m / 2 + body.wall_m / 2;
  const double z = CenterOf(layout.leaf).y();
  // display above, three by four keys below
  frame.push_back(
      ChamferedBox({kSafeJointM, y - 0.036, z + 0.045}, {0.006, y + 0.036, z + 0.08}, 0.002));
  for (int row = 0; row < 4; ++row) {
    for (int column = -1; column <= 1; ++column) {
      const double ky = y + 0.024 * column;
      const double kz = z + 0.022 - 0.024 * row;
      frame.push_back(ChamferedBox({kSafeJointM, ky - 0.009, kz - 0.009},
                                   {0.005, ky + 0.009, kz + 0.009}, 0.0015));
    }
  }
  AddShelves(body, layout.opening, 0, frame);
  AddTop(body, path, layout.box, 0, frame);
  AddBase(body, layout.box, 0, frame);
  return SafePart(body, path, layout.leaf, frame, LeafSolid(body, layout.leaf));
}

Part BuildAntique(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<AntiqueSafe>(json, path);
  Check(body, path);
  RequireRange(path, "steps", body.steps, 1, 5);
  RequireRange(path, "step_m", body.step_m, 0.006, 0.03);
  const double mouldings = body.steps * body.step_m;
  SafeLayout layout = LayoutOf(body, mouldings, mouldings, 0);
  const Rectangle outside = layout.box;
  layout.box.min_m.y() += mouldings;
  layout.box.max_m.y() -= mouldings;
  std::vector<Solid> frame = {SafeShell(body, layout, 0, path)};
  for (int i = 0; i < body.steps; ++i) {
    const double out = body.step_m * (i + 1);
    const double up = layout.box.max_m.y() + i * body.step_m;
    const double down = layout.box.min_m.y() - (i + 1) * body.step_m;
    const double y0 = outside.min_m.x() - out;
    const double y1 = outside.max_m.x() + out;
    // in front only as far as the leaf swings above and below nothing
    for (const double z : {up, down})
      frame.push_back(ChamferedBox({-body.depth_m, y0, z + kSafeJointM},
                                   {std::min(out, 0.03), y1, z + body.step_m - kSafeJointM},
                                   0.003));
  }
  AddShelves(body, layout.opening, 0, frame);
  AddBase(body, outside, 0, frame);
  return SafePart(body, path, layout.leaf, frame, LeafSolid(body, layout.leaf));
}

}  // namespace

std::span<const Family> SafeBodyFamilies() {
  static const Family kFamilies[] = {
      {"safe_box", PartRole::kBody, Mechanism::kNone, BuildSafeBox},
      {"safe_wall", PartRole::kBody, Mechanism::kNone, BuildWall},
      {"safe_vault", PartRole::kBody, Mechanism::kNone, BuildVault},
      {"safe_tiered", PartRole::kBody, Mechanism::kNone, BuildTiered},
      {"safe_hotel", PartRole::kBody, Mechanism::kNone, BuildHotel},
      {"safe_antique", PartRole::kBody, Mechanism::kNone, BuildAntique},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
