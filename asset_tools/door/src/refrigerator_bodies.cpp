// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "doorforge/core/error.h"

#include "family.h"
#include "leaf_layout.h"
#include "prism.h"
#include "sweep.h"

namespace doorforge::internal {
namespace {

constexpr double kJointM = 0.0002;         // between solids that touch
constexpr double kLeafToCabinetM = 0.004;  // the seal behind the leaf
constexpr double kBetweenLeavesM = 0.01;

/// What all refrigerators share: an insulated cabinet with a cavity, and a thick leaf before it.
struct Refrigerator {
  double leaf_width_m = 0.55;
  double leaf_height_m = 0.8;
  double thickness_m = 0.055;
  double depth_m = 0.5;  ///< Of the cabinet, without the leaf.
  double wall_m = 0.035;
  double corner_radius_m = 0.02;  ///< Of the outline, seen from the front.
  double edge_radius_m = 0.008;   ///< Of the leaf's front edge.
  double leaf_mass_kg = 8;
  double mount_height = 0.55;      ///< Of the leaf's height.
  double mount_to_edge_m = 0.055;  ///< From the free edge.
  int shelves = 3;
  std::string other = "none";   ///< A second front: "none", "above", "below", "beside".
  double other_m = 0.3;         ///< Its height or width.
  std::string base = "plinth";  ///< "plinth", "feet", "legs".
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
    visit("base", self.base);
    visit("base_height_m", self.base_height_m);
    visit("finish", self.finish);
    visit("leaf_finish", self.leaf_finish);
  }
};

struct ArchedRefrigerator : Refrigerator {
  double rise_m = 0.12;  ///< Of the arch over leaf and cabinet.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Refrigerator::VisitFields(self, visit);
    visit("rise_m", self.rise_m);
  }
};

struct IceboxRefrigerator : Refrigerator {
  double drum_diameter_m = 0.28;  ///< Of the compressor on top.
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
  if (body.other != "none") RequireRange(path, "other_m", body.other_m, 0.15, 0.5);
}

/// The whole front and the leaf in it, in (y, z).
struct FrontLayout {
  Eigen::Vector2d min_m, max_m;
  Eigen::Vector2d leaf_min_m, leaf_max_m;
  Eigen::Vector2d other_min_m, other_max_m;
};

FrontLayout LayoutOf(const Refrigerator& body, const std::string& path) {
  const double z = body.base_height_m;
  FrontLayout front{{0, z}, {body.leaf_width_m, z + body.leaf_height_m}, {}, {}, {}, {}};
  front.leaf_min_m = front.min_m;
  front.leaf_max_m = front.max_m;
  const double more = body.other_m + kBetweenLeavesM;
  if (body.other == "none") return front;
  if (body.other == "below") {
    front.leaf_min_m.y() += more;
    front.leaf_max_m.y() += more;
    front.other_min_m = front.min_m;
    front.other_max_m = {front.max_m.x(), z + body.other_m};
    front.max_m.y() += more;
  } else if (body.other == "above") {
    front.max_m.y() += more;
    front.other_min_m = {0, front.max_m.y() - body.other_m};
    front.other_max_m = front.max_m;
  } else if (body.other == "beside") {
    front.max_m.x() += more;
    front.other_min_m = {front.max_m.x() - body.other_m, z};
    front.other_max_m = front.max_m;
  } else {
    throw Error(ErrorCode::kInvalidConfig,
                path + ".other: found \"" + body.other + "\", allowed none, above, below, beside");
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
  return BoxPolygon(front.min_m.array() + in, front.max_m.array() - in);
}

void AddInside(const Refrigerator& body, const FrontLayout& front, const Polygon& cavity,
               std::vector<Solid>& solids) {
  const double front_x = -body.thickness_m - kLeafToCabinetM;
  const double back = front_x - body.depth_m + body.wall_m;
  const double z0 = std::max(front.leaf_min_m.y(), cavity[0].y());
  const double z1 = std::min(front.leaf_max_m.y(), cavity[2].y());
  for (int i = 1; i <= body.shelves; ++i) {
    const double z = z0 + (z1 - z0) * i / (body.shelves + 1);
    solids.push_back(ChamferedBox({back + kJointM, cavity[0].x() + kJointM, z - 0.003},
                                  {front_x - 0.04, cavity[2].x() - kJointM, z + 0.003}, 0.001));
  }
  if (body.other == "above" || body.other == "below") {
    const double z = body.other == "above" ? front.other_min_m.y() - kBetweenLeavesM / 2
                                           : front.other_max_m.y() + kBetweenLeavesM / 2;
    solids.push_back(ChamferedBox({back + kJointM, cavity[0].x() + kJointM, z - 0.015},
                                  {front_x, cavity[2].x() - kJointM, z + 0.015}, 0.001));
  } else if (body.other == "beside") {
    const double y = front.leaf_max_m.x() + kBetweenLeavesM / 2;
    // the shelves reach across; the wall between the two rooms is a low one at the front
    solids.push_back(ChamferedBox({front_x - 0.035, y - 0.015, cavity[0].y() + kJointM},
                                  {front_x, y + 0.015, cavity[2].y() - kJointM}, 0.001));
  }
}

void AddBase(const Refrigerator& body, const std::string& path, const FrontLayout& front,
             std::vector<Solid>& solids) {
  const double x1 = -body.thickness_m - 0.04;
  const double x0 = x1 + 0.04 - body.depth_m + 0.02;
  const double y0 = front.min_m.x() + 0.02 + 0.3 * body.corner_radius_m;
  const double y1 = front.max_m.x() - 0.02 - 0.3 * body.corner_radius_m;
  const double top = body.base_height_m - kJointM;
  if (body.base == "plinth") {
    solids.push_back(ChamferedBox({x0, y0, 0}, {x1, y1, top}, 0.004));
    return;
  }
  if (body.base != "feet" && body.base != "legs")
    throw Error(ErrorCode::kInvalidConfig,
                path + ".base: found \"" + body.base + "\", allowed plinth, feet, legs");
  for (const double x : {x0 + 0.03, x1 - 0.03}) {
    for (const double y : {y0 + 0.03, y1 - 0.03}) {
      const auto ring = [&](double half, double out, double z) {
        Ring points;
        const Eigen::Vector2d at(x, y + (y > (y0 + y1) / 2 ? out : -out));
        for (const Eigen::Vector2d& p : CirclePolygon(at, half, 14))
          points.emplace_back(p.x(), p.y(), z);
        return points;
      };
      if (body.base == "feet")
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

Part RefrigeratorPart(const Refrigerator& body, const std::string& path, const FrontLayout& front,
                      const BuiltShapes& shapes, const std::vector<Solid>& more) {
  const Polygon cavity = CavityOf(body, front);
  std::vector<Solid> frame = {Cabinet(body, shapes.outline, cavity)};
  AddInside(body, front, cavity, frame);
  AddBase(body, path, front, frame);
  if (body.other != "none") {
    const double radius =
        std::min(body.corner_radius_m, 0.3 * (front.other_max_m - front.other_min_m).minCoeff());
    frame.push_back(Slab(RoundedBoxPolygon(front.other_min_m, front.other_max_m, radius),
                         body.thickness_m, body.edge_radius_m));
  }
  frame.insert(frame.end(), more.begin(), more.end());
  Part part;
  part.joint = BodyHinge(0);
  part.pieces.push_back(MakePiece("frame", Joined(frame), body.finish, path + ".finish"));
  PartPiece leaf = MakePiece("leaf", Slab(shapes.leaf, body.thickness_m, body.edge_radius_m),
                             body.leaf_finish, path + ".leaf_finish");
  // skins, foam and what stands in the leaf: its volume says little
  leaf.mass.inertia_kg_m2 *= body.leaf_mass_kg / leaf.mass.mass_kg;
  leaf.mass.mass_kg = body.leaf_mass_kg;
  part.pieces.push_back(std::move(leaf));
  part.part_from_mount =
      Translation({0, body.leaf_width_m - body.mount_to_edge_m,
                   front.leaf_min_m.y() + body.mount_height * body.leaf_height_m});
  return part;
}

BuiltShapes RoundedShapes(const Refrigerator& body, const FrontLayout& front) {
  return {RoundedBoxPolygon(front.min_m, front.max_m, body.corner_radius_m),
          RoundedBoxPolygon(front.leaf_min_m, front.leaf_max_m, body.corner_radius_m)};
}

// The corners of the leaf follow those of the cabinet.
Part BuildBox(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<Refrigerator>(json, path);
  Check(body, path);
  const FrontLayout front = LayoutOf(body, path);
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

Part BuildArched(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<ArchedRefrigerator>(json, path);
  Check(body, path);
  RequireRange(path, "rise_m", body.rise_m, 0.04, 0.25);
  if (body.other == "above" || body.other == "beside")
    throw Error(ErrorCode::kInvalidConfig,
                path + ".other: found \"" + body.other + "\", allowed none, below under an arch");
  FrontLayout front = LayoutOf(body, path);
  const BuiltShapes shapes = {
      Arched(front.min_m, front.max_m, body.rise_m, body.corner_radius_m),
      Arched(front.leaf_min_m, front.leaf_max_m, body.rise_m, body.corner_radius_m)};
  // the cavity stays below the arch
  front.max_m.y() -= body.rise_m;
  return RefrigeratorPart(body, path, front, shapes, {});
}

Part BuildIcebox(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<IceboxRefrigerator>(json, path);
  Check(body, path);
  RequireRange(path, "drum_diameter_m", body.drum_diameter_m, 0.12, 0.4);
  RequireRange(path, "drum_height_m", body.drum_height_m, 0.04, 0.25);
  const FrontLayout front = LayoutOf(body, path);
  const double x = -body.thickness_m - kLeafToCabinetM - body.depth_m / 2;
  const double y = (front.min_m.x() + front.max_m.x()) / 2;
  const double z = front.max_m.y() + kJointM;
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
Part BuildFramed(const nlohmann::ordered_json& json, const std::string& path) {
  const auto body = ReadParameters<Refrigerator>(json, path);
  Check(body, path);
  FrontLayout front = LayoutOf(body, path);
  constexpr double kBorderM = 0.03;
  const Eigen::Vector2d low(-kBorderM, front.min_m.y());
  const Eigen::Vector2d high = front.max_m.array() + kBorderM;
  const BuiltShapes shapes = {
      RoundedBoxPolygon(low, high, body.corner_radius_m),
      RoundedBoxPolygon(front.leaf_min_m, front.leaf_max_m, 0.5 * body.corner_radius_m)};
  // a grille of ribs on top at the back
  std::vector<Solid> ribs;
  const double back = -body.thickness_m - kLeafToCabinetM - body.depth_m;
  for (int i = 0; i < 5; ++i) {
    const double x = back + 0.03 + 0.022 * i;
    ribs.push_back(ChamferedBox({x, low.x() + 0.06, high.y() + kJointM},
                                {x + 0.01, high.x() - 0.06, high.y() + 0.02}, 0.002));
  }
  return RefrigeratorPart(body, path, front, shapes, ribs);
}

}  // namespace

std::span<const Family> RefrigeratorBodyFamilies() {
  static const Family kFamilies[] = {
      {"refrigerator_box", PartRole::kBody, Mechanism::kNone, BuildBox},
      {"refrigerator_arched", PartRole::kBody, Mechanism::kNone, BuildArched},
      {"refrigerator_icebox", PartRole::kBody, Mechanism::kNone, BuildIcebox},
      {"refrigerator_framed", PartRole::kBody, Mechanism::kNone, BuildFramed},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
