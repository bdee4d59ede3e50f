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

constexpr double kRefrigeratorJointM = 0.0002;  // between solids that touch
constexpr double kLeafToCabinetM = 0.004;       // the seal behind the leaf
constexpr double kBetweenLeavesM = 0.01;
constexpr double kBinDepthM = 0.08;

/// Where a second front is, as seen from the leaf.
enum class SecondFront {
  kNone,
  kAbove,
  kBelow,
  kBeside,
};
inline constexpr NamedValue<SecondFront> kSecondFrontWords[] = {{SecondFront::kNone, "none"},
                                                                {SecondFront::kAbove, "above"},
                                                                {SecondFront::kBelow, "below"},
                                                                {SecondFront::kBeside, "beside"}};
constexpr std::span<const NamedValue<SecondFront>> ValuesOf(SecondFront) {
  return kSecondFrontWords;
}

/// What a refrigerator stands on.
enum class RefrigeratorBase {
  kPlinth,
  kFeet,
  kLegs,  ///< They are cabrioles.
};
inline constexpr NamedValue<RefrigeratorBase> kRefrigeratorBaseWords[] = {
    {RefrigeratorBase::kPlinth, "plinth"},
    {RefrigeratorBase::kFeet, "feet"},
    {RefrigeratorBase::kLegs, "legs"}};
constexpr std::span<const NamedValue<RefrigeratorBase>> ValuesOf(RefrigeratorBase) {
  return kRefrigeratorBaseWords;
}

/// What all refrigerators share: an insulated cabinet with a cavity, and a thick leaf before it.
struct Refrigerator {
  double leaf_width_m = 0.55;
  double leaf_height_m = 0.8;
  double thickness_m = 0.055;
  double depth_m = 0.5;  ///< The cabinet has it, without the leaf.
  double wall_m = 0.035;
  double corner_radius_m = 0.02;  ///< The outline has it, seen from the front.
  double edge_radius_m = 0.008;   ///< The leaf's front edge has it.
  double leaf_mass_kg = 8;
  double mount_height = 0.55;      ///< It is a share of the leaf's height.
  double mount_to_edge_m = 0.055;  ///< From the free edge.
  int shelves = 3;
  SecondFront other = SecondFront::kNone;
  double other_m = 0.3;    ///< Its height or width.
  int drawers = 0;         ///< Across the whole front, below everything else.
  double drawers_m = 0.3;  ///< Height of all of them.
  int bins = 0;            ///< Trays on the leaf's inner side.
  bool dispenser = false;  ///< A niche for ice and water in the front beside the leaf.
  bool condenser = false;  ///< Tubes behind the cabinet.
  RefrigeratorBase base = RefrigeratorBase::kPlinth;
  double base_height_m = 0.05;
  std::string finish = "sheet_white";
  std::string leaf_finish = "sheet_white";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("leaf_width_m", self.leaf_width_m);
    visit("leaf_height_m", self.leaf_height_m);
    visit("thickness_m", self.thickness_m);
    visit("depth_m", self.depth_m);
    visit("wall_m", self.wall_m);
    visit("corner_radius_m", self.corner_radius_m);
    visit("edge_radius_m", self.edge_radius_m);
    visit("leaf_mass_kg", self.leaf_mass_kg);
    visit("mount_height", self.mount_height);
    visit("mount_to_edge_m", self.mount_to_edge_m);
    visit("shelves", self.shelves);
    visit("other", self.other);
    visit("other_m", self.other_m);
    visit("drawers", self.drawers);
    visit("drawers_m", self.drawers_m);
    visit("bins", self.bins);
    visit("dispenser", self.dispenser);
    visit("condenser", self.condenser);
    visit("base", self.base);
    visit("base_height_m", self.base_height_m);
    visit("finish", self.finish);
    visit("leaf_finish", self.leaf_finish);
  }
};

struct ArchedRefrigerator : Refrigerator {
  double rise_m = 0.12;  ///< The arch over leaf and cabinet rises so far.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Refrigerator::VisitFields(self, visit);
    visit("rise_m", self.rise_m);
  }
};

struct IceboxRefrigerator : Refrigerator {
  double drum_diameter_m = 0.28;  ///< The compressor on top has it.
  double drum_height_m = 0.14;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Refrigerator::VisitFields(self, visit);
    visit("drum_diameter_m", self.drum_diameter_m);
    visit("drum_height_m", self.drum_height_m);
  }
};

void Check(const Refrigerator& body, const std::string& path) {
  RequireRange(path, "leaf_width_m", body.leaf_width_m, 0.43, 0.68);
  RequireRange(path, "leaf_height_m", body.leaf_height_m, 0.5, 1.4);
  RequireRange(path, "thickness_m", body.thickness_m, 0.03, 0.09);
  RequireRange(path, "depth_m", body.depth_m, 0.3, 0.72);
  RequireRange(path, "wall_m", body.wall_m, 0.02, 0.07);
  RequireRange(path, "corner_radius_m", body.corner_radius_m, 0.006, 0.12);
  RequireRange(path, "edge_radius_m", body.edge_radius_m, 0.002, 0.4 * body.thickness_m);
  RequireRange(path, "leaf_mass_kg", body.leaf_mass_kg, 5, 20);
  RequireRange(path, "mount_height", body.mount_height, 0.2, 0.8);
  RequireRange(path, "mount_to_edge_m", body.mount_to_edge_m, body.edge_radius_m + 0.032, 0.12);
  RequireRange(path, "shelves", body.shelves, 0, 5);
  RequireRange(path, "base_height_m", body.base_height_m, 0.02, 0.3);
  if (body.other != SecondFront::kNone) RequireRange(path, "other_m", body.other_m, 0.15, 0.5);
  RequireRange(path, "drawers", body.drawers, 0, 3);
  if (body.drawers > 0) RequireRange(path, "drawers_m", body.drawers_m, 0.14 * body.drawers, 0.6);
  RequireRange(path, "bins", body.bins, 0, 4);
}

/// The whole front and the leaf in it, in (y, z).
struct FrontLayout {
  Rectangle whole;
  Rectangle leaf;
  std::vector<Rectangle> others;   ///< Fronts that stand still.
  std::vector<double> levels_m;    ///< Between the rooms of the cabinet.
  std::vector<double> uprights_m;  ///< These are places along y.
};

void AddOther(const Refrigerator& body, FrontLayout& front) {
  const double more = body.other_m + kBetweenLeavesM;
  const double z = front.leaf.min_m.y();
  Rectangle other = front.leaf;
  if (body.other == SecondFront::kBelow) {
    front.leaf.min_m.y() += more;
    front.leaf.max_m.y() += more;
    other.max_m.y() = z + body.other_m;
    front.levels_m.push_back(other.max_m.y() + kBetweenLeavesM / 2);
  } else if (body.other == SecondFront::kAbove) {
    other.min_m.y() = front.leaf.max_m.y() + kBetweenLeavesM;
    other.max_m.y() = other.min_m.y() + body.other_m;
    front.levels_m.push_back(other.min_m.y() - kBetweenLeavesM / 2);
  } else {
    other.min_m.x() = front.leaf.max_m.x() + kBetweenLeavesM;
    other.max_m.x() = other.min_m.x() + body.other_m;
    front.uprights_m.push_back(other.min_m.x() - kBetweenLeavesM / 2);
  }
  front.others.push_back(other);
}

FrontLayout LayoutOf(const Refrigerator& body) {
  const double base = body.base_height_m;
  const double z = base + (body.drawers > 0 ? body.drawers_m + kBetweenLeavesM : 0);
  FrontLayout front;
  front.leaf = {{0, z}, {body.leaf_width_m, z + body.leaf_height_m}};
  if (body.other != SecondFront::kNone) AddOther(body, front);
  front.whole = {{0, base}, front.leaf.max_m};
  for (const Rectangle& other : front.others)
    front.whole.max_m = front.whole.max_m.cwiseMax(other.max_m);
  const double height = (z - base) / std::max(1, body.drawers);
  for (int i = 0; i < body.drawers; ++i) {
    const double low = base + i * height;
    front.others.push_back({{0, low}, {front.whole.max_m.x(), low + height - kBetweenLeavesM}});
    front.levels_m.push_back(low + height - kBetweenLeavesM / 2);
  }
  return front;
}

// A slab with this outline; the rim of its front is rounded.
Solid Slab(const Polygon& outline, double thickness, double edge) {
  const auto ring = [&](double inset, double x) {
    Ring points;
    for (const Eigen::Vector2d& p : Inset(outline, inset)) points.emplace_back(x, p.x(), p.y());
    return points;
  };
  std::vector<Ring> rings = {ring(0.002, -thickness), ring(0, -thickness + 0.002)};
  for (const double degrees : {0.0, 22.5, 45.0, 67.5, 90.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    rings.push_back(ring(edge * (1 - std::cos(angle)), -edge * (1 - std::sin(angle))));
  }
  return LoftSolid(rings, 0.002);
}

Solid Cabinet(const Refrigerator& body, const Polygon& outline, const Polygon& cavity) {
  CupShape cup;
  cup.outer = outline;
  cup.outer_hull = outline;
  cup.inner = cavity;
  cup.inner_hull = cavity;
  cup.front_x_m = -body.thickness_m - kLeafToCabinetM;
  cup.back_x_m = cup.front_x_m - body.depth_m;
  cup.floor_x_m = cup.back_x_m + body.wall_m;
  cup.edge_radius_m = 0.004;
  return CupSolid(cup);
}

Polygon CavityOf(const Refrigerator& body, const FrontLayout& front) {
  const double in = std::max(body.wall_m, 0.35 * body.corner_radius_m);
  return BoxPolygon(front.whole.min_m.array() + in, front.whole.max_m.array() - in);
}

void AddInside(const Refrigerator& body, const FrontLayout& front, const Polygon& cavity,
               std::vector<Solid>& solids) {
  const double front_x = -body.thickness_m - kLeafToCabinetM;
  const double back = front_x - body.depth_m + body.wall_m;
  const auto level = [&](double z, double half, double to_x) {
    solids.push_back(
        ChamferedBox({back + kRefrigeratorJointM, cavity[0].x() + kRefrigeratorJointM, z - half},
                     {to_x, cavity[2].x() - kRefrigeratorJointM, z + half}, 0.001));
  };
  const double z0 = std::max(front.leaf.min_m.y(), cavity[0].y());
  const double z1 = std::min(front.leaf.max_m.y(), cavity[2].y());
  // the trays on the leaf need room
  const double shelf_front = front_x - (body.bins > 0 ? kBinDepthM + 0.05 : 0.04);
  for (int i = 1; i <= body.shelves; ++i)
    level(z0 + (z1 - z0) * i / (body.shelves + 1), 0.003, shelf_front);
  for (const double z : front.levels_m) level(z, 0.015, front_x);
  const double bottom = body.drawers > 0 ? front.leaf.min_m.y() + 0.015 : cavity[0].y();
  // the shelves reach across; the wall between the two rooms is a low one at the front
  for (const double y : front.uprights_m)
    solids.push_back(ChamferedBox({front_x - 0.035, y - 0.015, bottom + kRefrigeratorJointM},
                                  {front_x, y + 0.015, cavity[2].y() - kRefrigeratorJointM},
                                  0.001));
}

// A tray is a floor with a lip before it; what stands in them belongs to the leaf's mass.
std::vector<Solid> Bins(const Refrigerator& body, const FrontLayout& front, const Polygon& cavity) {
  std::vector<Solid> solids;
  const double x1 = -body.thickness_m - kRefrigeratorJointM;
  const double y0 = std::max(front.leaf.min_m.x(), cavity[0].x()) + 0.03;
  const double y1 = std::min(front.leaf.max_m.x(), cavity[2].x()) - 0.05;
  const double z0 = std::max(front.leaf.min_m.y(), cavity[0].y()) + 0.05;
  const double z1 = std::min(front.leaf.max_m.y(), cavity[2].y()) - 0.16;
  for (int i = 0; i < body.bins; ++i) {
    const double z = z0 + (z1 - z0) * i / std::max(1, body.bins - 1);
    solids.push_back(
        ChamferedBox({x1 - kBinDepthM, y0, z}, {x1, y1, z + 0.006 - kRefrigeratorJointM}, 0.001));
    solids.push_back(ChamferedBox({x1 - kBinDepthM, y0, z + 0.006},
                                  {x1 - kBinDepthM + 0.006, y1, z + 0.07}, 0.001));
  }
  return solids;
}

// A bezel with a sunk field and a tray that stands out below it.
void AddDispenser(const Rectangle& front, std::vector<Solid>& solids) {
  const Eigen::Vector2d center = (front.min_m + front.max_m) / 2;
  const Eigen::Vector2d half(0.09, 0.14);
  ReliefSlab bezel;
  bezel.outline = {center - half, center + half};
  bezel.thickness_m = 0.016;
  bezel.edge_radius_m = 0.004;
  bezel.fields = {{{bezel.outline.min_m.array() + 0.016, bezel.outline.max_m.array() - 0.016},
                   SunkPanel(0.012, 0.004),
                   ReliefSide::kFront}};
  solids.push_back(Moved(ReliefSolid(bezel, 0.006), {0.016 + kRefrigeratorJointM, 0, 0}));
  solids.push_back(ChamferedBox({0.0165, center.x() - 0.07, center.y() - 0.135},
                                {0.045, center.x() + 0.07, center.y() - 0.122}, 0.003));
}

// A ladder of tubes: two uprights and what runs between them.
void AddCondenser(const Refrigerator& body, const FrontLayout& front, std::vector<Solid>& solids) {
  constexpr double kTubeM = 0.005;
  constexpr int kTubes = 8;
  const double x =
      -body.thickness_m - kLeafToCabinetM - body.depth_m - kTubeM - kRefrigeratorJointM;
  const double y0 = front.whole.min_m.x() + 0.06;
  const double y1 = front.whole.max_m.x() - 0.06;
  const double z0 = front.whole.min_m.y() + 0.1;
  const double z1 = front.whole.max_m.y() - 0.2;
  for (const double y : {y0, y1})
    solids.push_back(ConvexPrism(CirclePolygon({x, y}, kTubeM, 10), PrismAxis::kZ, {z0, z1}, 0));
  for (int i = 0; i < kTubes; ++i) {
    const double z = z0 + (z1 - z0) * (i + 0.5) / kTubes;
    solids.push_back(
        ConvexPrism(CirclePolygon({z, x - 2 * kTubeM - kRefrigeratorJointM}, kTubeM, 10),
                    PrismAxis::kY, {y0 - 0.01, y1 + 0.01}, 0));
  }
}

// A bar in front of a drawer, near its upper edge.
void AddDrawerPull(const Rectangle& front, std::vector<Solid>& solids) {
  const double y = (front.min_m.x() + front.max_m.x()) / 2;
  const double half = 0.32 * (front.max_m.x() - front.min_m.x());
  const double z = front.max_m.y() - 0.035;
  for (const double side : {-0.85, 0.85})
    solids.push_back(ChamferedBox({kRefrigeratorJointM, y + side * half - 0.008, z - 0.006},
                                  {0.022, y + side * half + 0.008, z + 0.006}, 0.001));
  solids.push_back(ConvexPrism(RoundedBoxPolygon({z - 0.008, 0.0222}, {z + 0.008, 0.034}, 0.004),
                               PrismAxis::kY, {y - half, y + half}, 0.002));
}

void AddBase(const Refrigerator& body, const FrontLayout& front, std::vector<Solid>& solids) {
  const double x1 = -body.thickness_m - 0.04;
  const double x0 = x1 + 0.04 - body.depth_m + 0.02;
  const double y0 = front.whole.min_m.x() + 0.02 + 0.3 * body.corner_radius_m;
  const double y1 = front.whole.max_m.x() - 0.02 - 0.3 * body.corner_radius_m;
  const double top = body.base_height_m - kRefrigeratorJointM;
  if (body.base == RefrigeratorBase::kPlinth) {
    solids.push_back(ChamferedBox({x0, y0, 0}, {x1, y1, top}, 0.004));
    return;
  }
  for (const double x : {x0 + 0.03, x1 - 0.03}) {
    for (const double y : {y0 + 0.03, y1 - 0.03}) {
      const auto ring = [&](double half, double out, double z) {
        Ring points;
        const Eigen::Vector2d at(x, y + (y > (y0 + y1) / 2 ? out : -out));
        for (const Eigen::Vector2d& p : CirclePolygon(at, half, 14))
          points.emplace_back(p.x(), p.y(), z);
        return points;
      };
      if (body.base == RefrigeratorBase::kFeet)
        solids.push_back(
            LoftSolid({ring(0.02, 0, 0), ring(0.022, 0, 0.003), ring(0.018, 0, top)}, 0.003));
      else  // a cabriole: out at the knee, in at the ankle
        solids.push_back(LoftSolid(
            {ring(0.017, 0.012, 0), ring(0.02, 0.012, 0.01), ring(0.012, 0.006, 0.25 * top),
             ring(0.016, 0.004, 0.6 * top), ring(0.028, 0.006, 0.88 * top), ring(0.03, 0, top)},
            0.003));
    }
  }
}

struct BuiltShapes {
  Polygon outline;
  Polygon leaf;
};

void AddFronts(const Refrigerator& body, const FrontLayout& front, std::vector<Solid>& solids) {
  for (std::size_t i = 0; i < front.others.size(); ++i) {
    const Rectangle& other = front.others[i];
    const double radius =
        std::min(body.corner_radius_m, 0.3 * (other.max_m - other.min_m).minCoeff());
    solids.push_back(Slab(RoundedBoxPolygon(other.min_m, other.max_m, radius), body.thickness_m,
                          body.edge_radius_m));
    const bool beside = body.other == SecondFront::kBeside && i == 0;
    if (beside && body.dispenser) AddDispenser(other, solids);
    if (other.max_m.y() < front.leaf.min_m.y()) AddDrawerPull(other, solids);
  }
}

Part RefrigeratorPart(const Refrigerator& body, const std::string& path, const FrontLayout& front,
                      const BuiltShapes& shapes, const std::vector<Solid>& more) {
  const Polygon cavity = CavityOf(body, front);
  std::vector<Solid> frame = {Cabinet(body, shapes.outline, cavity)};
  AddInside(body, front, cavity, frame);
  AddBase(body, front, frame);
  AddFronts(body, front, frame);
  if (body.condenser) AddCondenser(body, front, frame);
  frame.insert(frame.end(), more.begin(), more.end());
  Part part;
  part.joint = BodyHinge(0);
  part.pieces.push_back(MakePiece("frame", Joined(frame), body.finish, path + ".finish"));
  std::vector<Solid> door = {Slab(shapes.leaf, body.thickness_m, body.edge_radius_m)};
  for (Solid& bin : Bins(body, front, cavity)) door.push_back(std::move(bin));
  PartPiece leaf = MakePiece("leaf", Joined(door), body.leaf_finish, path + ".leaf_finish");
  // skins, foam and what stands in the leaf: its volume says little
  leaf.mass.inertia_kg_m2 *= body.leaf_mass_kg / leaf.mass.mass_kg;
  leaf.mass.mass_kg = body.leaf_mass_kg;
  part.pieces.push_back(std::move(leaf));
  part.part_from_mount =
      Translation({0, body.leaf_width_m - body.mount_to_edge_m,
                   front.leaf.min_m.y() + body.mount_height * body.leaf_height_m});
  return part;
}

BuiltShapes RoundedShapes(const Refrigerator& body, const FrontLayout& front) {
  return {RoundedBoxPolygon(front.whole.min_m, front.whole.max_m, body.corner_radius_m),
          RoundedBoxPolygon(front.leaf.min_m, front.leaf.max_m, body.corner_radius_m)};
}

// The corners of the leaf follow those of the cabinet.
Part BuildRefrigeratorBox(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<Refrigerator>(json, path);
  Check(body, path);
  const FrontLayout front = LayoutOf(body);
  return RefrigeratorPart(body, path, front, RoundedShapes(body, front), {});
}

// A rectangle whose upper side is an arc.
Polygon Arched(const Eigen::Vector2d& min, const Eigen::Vector2d& max, double rise, double corner) {
  constexpr int kSteps = 14;
  Polygon outline = {
      {min.x() + corner, min.y()}, {max.x() - corner, min.y()}, {max.x(), min.y() + corner}};
  const Eigen::Vector2d half((max.x() - min.x()) / 2, rise);
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = std::numbers::pi * i / kSteps;
    // steeper at the shoulders than an ellipse would be flat on top
    const double power = 0.75;
    const double c = std::cos(angle);
    outline.emplace_back(
        (min.x() + max.x()) / 2 + half.x() * std::copysign(std::pow(std::abs(c), power), c),
        max.y() - rise + rise * std::pow(std::sin(angle), power));
  }
  outline.emplace_back(min.x(), min.y() + corner);
  return outline;
}

Part BuildRefrigeratorArched(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<ArchedRefrigerator>(json, path);
  Check(body, path);
  RequireRange(path, "rise_m", body.rise_m, 0.04, 0.25);
  if (body.other == SecondFront::kAbove || body.other == SecondFront::kBeside)
    throw Error(ErrorCode::kInvalidConfig, path + ".other: found \"" +
                                               std::string(NameOf(body.other)) +
                                               "\", allowed none, below under an arch");
  FrontLayout front = LayoutOf(body);
  const BuiltShapes shapes = {
      Arched(front.whole.min_m, front.whole.max_m, body.rise_m, body.corner_radius_m),
      Arched(front.leaf.min_m, front.leaf.max_m, body.rise_m, body.corner_radius_m)};
  // the cavity stays below the arch
  front.whole.max_m.y() -= body.rise_m;
  return RefrigeratorPart(body, path, front, shapes, {});
}

Part BuildIcebox(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<IceboxRefrigerator>(json, path);
  Check(body, path);
  RequireRange(path, "drum_diameter_m", body.drum_diameter_m, 0.12, 0.4);
  RequireRange(path, "drum_height_m", body.drum_height_m, 0.04, 0.25);
  const FrontLayout front = LayoutOf(body);
  const double x = -body.thickness_m - kLeafToCabinetM - body.depth_m / 2;
  const double y = (front.whole.min_m.x() + front.whole.max_m.x()) / 2;
  const double z = front.whole.max_m.y() + kRefrigeratorJointM;
  const auto ring = [&](double radius, double up) {
    Ring points;
    for (const Eigen::Vector2d& p : CirclePolygon({x, y}, radius, 28))
      points.emplace_back(p.x(), p.y(), z + up);
    return points;
  };
  const double r = body.drum_diameter_m / 2;
  const double h = body.drum_height_m;
  const Solid drum = LoftSolid({ring(r + 0.02, 0), ring(r + 0.02, 0.012), ring(r, 0.016),
                                ring(r, 0.75 * h), ring(0.9 * r, 0.93 * h), ring(0.6 * r, h)},
                               0.004);
  return RefrigeratorPart(body, path, front, RoundedShapes(body, front), {drum});
}

// A leaf and a second front stand before a cabinet that is wider and higher than both.
Part BuildRefrigeratorFramed(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<Refrigerator>(json, path);
  Check(body, path);
  const FrontLayout front = LayoutOf(body);
  constexpr double kBorderM = 0.03;
  const Eigen::Vector2d low(-kBorderM, front.whole.min_m.y());
  const Eigen::Vector2d high = front.whole.max_m.array() + kBorderM;
  const BuiltShapes shapes = {
      RoundedBoxPolygon(low, high, body.corner_radius_m),
      RoundedBoxPolygon(front.leaf.min_m, front.leaf.max_m, 0.5 * body.corner_radius_m)};
  // a grille of ribs on top at the back
  std::vector<Solid> ribs;
  const double back = -body.thickness_m - kLeafToCabinetM - body.depth_m;
  for (int i = 0; i < 5; ++i) {
    const double x = back + 0.03 + 0.022 * i;
    ribs.push_back(ChamferedBox({x, low.x() + 0.06, high.y() + kRefrigeratorJointM},
                                {x + 0.01, high.x() - 0.06, high.y() + 0.02}, 0.002));
  }
  return RefrigeratorPart(body, path, front, shapes, ribs);
}

}  // namespace

std::span<const Family> RefrigeratorBodyFamilies() {
  static const Family kFamilies[] = {
      {"refrigerator_box", PartRole::kBody, Mechanism::kNone, BuildRefrigeratorBox},
      {"refrigerator_arched", PartRole::kBody, Mechanism::kNone, BuildRefrigeratorArched},
      {"refrigerator_icebox", PartRole::kBody, Mechanism::kNone, BuildIcebox},
      {"refrigerator_framed", PartRole::kBody, Mechanism::kNone, BuildRefrigeratorFramed},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
