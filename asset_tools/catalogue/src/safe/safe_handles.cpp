// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "doorforge/solids/prism.h"
#include "doorforge/solids/sweep.h"

#include "handles/handle_base.h"

// Handles of safes. Two mechanisms: a key is twisted about its own axis, a valve is pushed round at
// an arm or rim that stands off it.

namespace doorforge::internal {
namespace {

constexpr double kSafeHandleHullToleranceM = 0.001;
constexpr double kSafeHandleJointM = 0.0002;  // between solids that touch

/// Outline of the plate under a safe's handle.
enum class PlateOutline {
  kRound,  ///< It is a stadium if it is not as high as wide.
  kSquare,
  kShield,  ///< It is tall and rounded.
  kOctagon,
  kDiamond,
};
inline constexpr NamedValue<PlateOutline> kPlateOutlineWords[] = {
    {PlateOutline::kRound, "round"},
    {PlateOutline::kSquare, "square"},
    {PlateOutline::kShield, "shield"},
    {PlateOutline::kOctagon, "octagon"},
    {PlateOutline::kDiamond, "diamond"}};
constexpr std::span<const NamedValue<PlateOutline>> ValuesOf(PlateOutline) {
  return kPlateOutlineWords;
}

/// The plate on the leaf under every handle of a safe.
struct SafePlate {
  PlateOutline shape = PlateOutline::kRound;
  double width_m = 0.106;
  double height_m = 0;   ///< 0: as high as wide; a shield 1.25 times.
  bool stepped = false;  ///< A smaller plate of half the thickness lies on it.
  double thickness_m = 0.006;
  std::string finish = "satin_aluminium";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("shape", self.shape);
    visit("width_m", self.width_m);
    visit("height_m", self.height_m);
    visit("stepped", self.stepped);
    visit("thickness_m", self.thickness_m);
    visit("finish", self.finish);
  }
};

/// Outline of what fingers turn a key by.
enum class KeyBow {
  kOval,
  kSquare,
  kClover,
  kTriangle,
  kButterfly,
};
inline constexpr NamedValue<KeyBow> kKeyBowWords[] = {{KeyBow::kOval, "oval"},
                                                      {KeyBow::kSquare, "square"},
                                                      {KeyBow::kClover, "clover"},
                                                      {KeyBow::kTriangle, "triangle"},
                                                      {KeyBow::kButterfly, "butterfly"}};
constexpr std::span<const NamedValue<KeyBow>> ValuesOf(KeyBow) { return kKeyBowWords; }

struct SafeKey {
  double bow_height_m = 0.04;  ///< Along z.
  double bow_depth_m = 0.034;  ///< Along x.
  double bow_thickness_m = 0.006;
  double reach_m = 0.042;  ///< From the leaf to the middle of the bow.
  KeyBow bow = KeyBow::kOval;
  double barrel_radius_m = 0.013;
  double barrel_m = 0.012;  ///< The lock's barrel stands out so far along x from the plate.
  SafePlate plate;
  std::string finish = "polished_brass";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("bow_height_m", self.bow_height_m);
    visit("bow_depth_m", self.bow_depth_m);
    visit("bow_thickness_m", self.bow_thickness_m);
    visit("reach_m", self.reach_m);
    visit("bow", self.bow);
    visit("barrel_radius_m", self.barrel_radius_m);
    visit("barrel_m", self.barrel_m);
    visit("plate", self.plate);
    visit("finish", self.finish);
  }
};

/// What handles with bars have in common.
struct SafeBars {
  double length_m = 0.12;       ///< T: whole bar; others: from the axis to the tip.
  double projection_m = 0.045;  ///< From the leaf to the bars' centre line.
  double bar_width_m = 0.014;   ///< In the plane of the leaf.
  double bar_depth_m = 0.014;   ///< Along x.
  double squareness = 2;
  double tip_scale = 1;  ///< Size at the tips relative to the root.
  double hub_diameter_m = 0.036;
  double angle_deg = 0;  ///< Turns the whole grip at rest, positive as it unlocks.
  SafePlate plate;
  std::string finish = "brushed_steel";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("length_m", self.length_m);
    visit("projection_m", self.projection_m);
    visit("bar_width_m", self.bar_width_m);
    visit("bar_depth_m", self.bar_depth_m);
    visit("squareness", self.squareness);
    visit("tip_scale", self.tip_scale);
    visit("hub_diameter_m", self.hub_diameter_m);
    visit("angle_deg", self.angle_deg);
    visit("plate", self.plate);
    visit("finish", self.finish);
  }
};

struct SafeTee : SafeBars {
  double sweep_m = 0;  ///< How far the bar's ends bend towards the leaf.
  double vee_m = 0;    ///< How far they bend up, in the plane of the leaf.
  double ball_m = 0;   ///< Diameter of a ball at each end; 0 for none.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    SafeBars::VisitFields(self, visit);
    visit("sweep_m", self.sweep_m);
    visit("vee_m", self.vee_m);
    visit("ball_m", self.ball_m);
  }
};

struct SafeEll : SafeBars {
  double ball_m = 0;  ///< Diameter of a ball at the tip; 0 for none.
  double post_m = 0;  ///< Length of a post at the tip that stands out of the leaf: a crank.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    SafeBars::VisitFields(self, visit);
    visit("ball_m", self.ball_m);
    visit("post_m", self.post_m);
  }
};

struct SafeDialLever : SafeEll {
  double dial_diameter_m = 0.056;
  double dial_height_m = 0.085;  ///< The dial's axis lies so far above the lever's.
  double dial_shift_m = 0;       ///< It lies so far towards the free edge.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    SafeEll::VisitFields(self, visit);
    visit("dial_diameter_m", self.dial_diameter_m);
    visit("dial_height_m", self.dial_height_m);
    visit("dial_shift_m", self.dial_shift_m);
  }
};

struct SafeSpokes : SafeBars {
  int spokes = 3;
  double dish_m = 0;  ///< How much farther out than their roots the tips are.
  double ball_m = 0;  ///< Diameter of a ball at each tip; 0 for none.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    SafeBars::VisitFields(self, visit);
    visit("spokes", self.spokes);
    visit("dish_m", self.dish_m);
    visit("ball_m", self.ball_m);
  }
};

struct SafeWheel : SafeBars {
  int spokes = 3;
  double rim_width_m = 0.014;  ///< The rim's section has it along the radius.
  double rim_depth_m = 0.014;
  double over_m = 0;  ///< How far the spokes stand out beyond the rim, as on a ship's wheel.
  double dish_m = 0;  ///< How much farther out than the hub the rim is.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    SafeBars::VisitFields(self, visit);
    visit("spokes", self.spokes);
    visit("rim_width_m", self.rim_width_m);
    visit("rim_depth_m", self.rim_depth_m);
    visit("over_m", self.over_m);
    visit("dish_m", self.dish_m);
  }
};

void Check(const SafeBars& bars, const std::string& path) {
  RequireRange(path, "length_m", bars.length_m, 0.06, 0.18);
  RequireRange(path, "projection_m", bars.projection_m, 0.034, 0.07);
  RequireRange(path, "bar_width_m", bars.bar_width_m, 0.007, 0.026);
  RequireRange(path, "bar_depth_m", bars.bar_depth_m, 0.007, 0.026);
  RequireRange(path, "squareness", bars.squareness, 2, 10);
  RequireRange(path, "tip_scale", bars.tip_scale, 0.5, 1.6);
  RequireRange(path, "hub_diameter_m", bars.hub_diameter_m, 0.016, 0.09);
  RequireRange(path, "angle_deg", bars.angle_deg, -90, 90);
}

// A plate of this half size and thickness.
Solid PlateOf(const SafePlate& plate, const Eigen::Vector2d& half, double thickness) {
  const double edge = 0.4 * thickness;
  const double least = half.minCoeff();
  if (plate.shape == PlateOutline::kSquare)
    return PlateSolid({half, 0.008, thickness, edge}, {0, 0});
  if (plate.shape == PlateOutline::kShield)
    return PlateSolid({half, 0.5 * least, thickness, edge}, {0, 0});
  if (plate.shape == PlateOutline::kRound)
    return PlateSolid({half, least, thickness, edge}, {0, 0});
  Polygon outline;
  if (plate.shape == PlateOutline::kDiamond) {
    outline = {{half.x(), 0}, {0, half.y()}, {-half.x(), 0}, {0, -half.y()}};
  } else {
    for (const Eigen::Vector2d& p : CirclePolygon({0, 0}, 1 / std::cos(std::numbers::pi / 8), 8))
      outline.emplace_back(p.cwiseProduct(half));
  }
  // its one hull has no chamfer, so a sharp corner allows only a small one
  return ConvexPrism(outline, PrismAxis::kX, {0, thickness}, 0.2 * thickness);
}

// The plate as "rose"; returns where the grip may begin.
double AddPlate(const SafePlate& plate, const std::string& path, const std::vector<Solid>& on_it,
                Part& part) {
  RequireRange(path, "width_m", plate.width_m, 0.04, 0.22);
  if (plate.height_m != 0) RequireRange(path, "height_m", plate.height_m, 0.04, 0.21);
  RequireRange(path, "thickness_m", plate.thickness_m, 0.003, 0.012);
  Eigen::Vector2d half(plate.width_m / 2, plate.height_m / 2);
  if (plate.height_m == 0) half.y() = (plate.shape == PlateOutline::kShield ? 1.25 : 1) * half.x();
  std::vector<Solid> solids = {PlateOf(plate, half, plate.thickness_m)};
  double top = plate.thickness_m + kSafeHandleJointM;
  if (plate.stepped) {
    solids.push_back(Moved(PlateOf(plate, 0.72 * half, plate.thickness_m / 2), {top, 0, 0}));
    top += plate.thickness_m / 2 + kSafeHandleJointM;
  }
  for (const Solid& solid : on_it) solids.push_back(Moved(solid, {top, 0, 0}));
  part.pieces.push_back(MakePiece("rose", Joined(solids), plate.finish, path));
  return top + kSafeHandleJointM;
}

Solid Lathed(const std::vector<LathePoint>& profile, int sides = 28) {
  return LatheSolid(profile, {sides, 0, 0});
}

// A drum about the axis with rounded ends.
Solid Hub(double radius, double from_x, double to_x) {
  const double r = std::min(0.004, 0.3 * radius);
  return Lathed({{from_x, radius - 0.001},
                 {from_x + 0.001, radius},
                 {to_x - r, radius},
                 {to_x - 0.3 * r, radius - 0.3 * r},
                 {to_x, radius - r}});
}

Solid Ball(const Eigen::Vector3d& center, double radius) {
  std::vector<LathePoint> profile;
  for (int i = 0; i <= 10; ++i) {
    const double angle = std::numbers::pi * (0.06 + 0.88 * i / 10);
    profile.push_back({-radius * std::cos(angle), radius * std::sin(angle)});
  }
  return Moved(Lathed(profile, 20), center);
}

// A straight bar from `from` to `to`.
Solid Bar(const SafeBars& bars, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
          bool domed) {
  const auto section = [&](double fraction) {
    const double scale = 1 + (bars.tip_scale - 1) * fraction;
    return Section{bars.bar_width_m / 2 * scale, bars.bar_depth_m / 2 * scale, bars.squareness};
  };
  const double dome = domed ? 0.4 * std::min(bars.bar_width_m, bars.bar_depth_m) : 0;
  const std::vector<PathPoint> path = FilletedPath({from, (from + to) / 2, to}, 0.001);
  return LoftSolid(SweepRings(path, Eigen::Vector3d::UnitX(), section, dome),
                   kSafeHandleHullToleranceM);
}

// Direction in the leaf's plane; 0 is towards the hinge, positive as the handle turns.
Eigen::Vector3d DirectionAt(double angle) { return {0, -std::cos(angle), -std::sin(angle)}; }

// A bar from the hub along `direction`, with its tip `dish_m` farther out and a ball there or not.
std::vector<Solid> Arm(const SafeBars& bars, const Eigen::Vector3d& direction, double dish_m,
                       double ball_m) {
  const Eigen::Vector3d root = direction * (bars.hub_diameter_m / 2 + kSafeHandleJointM) +
                               Eigen::Vector3d(bars.projection_m, 0, 0);
  const double length = bars.length_m - (ball_m > 0 ? ball_m - kSafeHandleJointM : 0);
  const Eigen::Vector3d tip =
      direction * length + Eigen::Vector3d(bars.projection_m + dish_m, 0, 0);
  std::vector<Solid> solids = {Bar(bars, root, tip, ball_m <= 0)};
  if (ball_m > 0)
    solids.push_back(
        Ball(tip + (tip - root).normalized() * (ball_m / 2 + kSafeHandleJointM), ball_m / 2));
  return solids;
}

struct GripParts {
  std::vector<Solid> solids;
  Eigen::Vector3d grasp_m;  ///< Before the turn by angle_deg.
  Eigen::Vector3d closing;  ///< Direction in which the fingers close.
  Eigen::Vector3d half_extent_m;
};

RigidTransform GraspFrame(const Eigen::Vector3d& position, const Eigen::Vector3d& closing) {
  const Eigen::Vector3d approach = -Eigen::Vector3d::UnitX();
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() << closing.cross(approach), closing, approach;
  pose.translation() = position;
  return pose;
}

Part Finished(Part part, const GripParts& grip, const SafeBars& bars, const std::string& path) {
  const RigidTransform turn =
      RotationAbout(Eigen::Vector3d::UnitX(), bars.angle_deg * std::numbers::pi / 180);
  part.pieces.push_back(
      MakePiece("grip", Transformed(Joined(grip.solids), turn), bars.finish, path + ".finish"));
  part.joint = HandleJoint(true);
  part.part_from_grasp = turn * GraspFrame(grip.grasp_m, grip.closing);
  part.grasp_half_extent_m = grip.half_extent_m;
  return part;
}

void CheckBall(const SafeBars& bars, double ball_m, const std::string& path) {
  if (ball_m > 0) RequireRange(path, "ball_m", ball_m, bars.bar_width_m, 0.034);
}

Polygon BowOutline(const SafeKey& key) {
  // in (z, x) around the origin
  const Eigen::Vector2d half(key.bow_height_m / 2, key.bow_depth_m / 2);
  if (key.bow == KeyBow::kSquare) return RoundedRectangle(half, 0.006, 3);
  if (key.bow == KeyBow::kTriangle) {
    // wide in front
    return {{-0.35 * half.x(), -half.y()}, {0.35 * half.x(), -half.y()},
            {half.x(), 0.6 * half.y()},    {0.7 * half.x(), half.y()},
            {-0.7 * half.x(), half.y()},   {-half.x(), 0.6 * half.y()}};
  }
  if (key.bow == KeyBow::kClover) return RoundedRectangle(half, 0.85 * half.minCoeff(), 6);
  Polygon oval;
  for (const Eigen::Vector2d& p : CirclePolygon({0, 0}, 1, 24))
    oval.emplace_back(p.cwiseProduct(half));
  return oval;
}

// Two round wings beside a waist; the polygons are in (z, x).
std::vector<Polygon> BowPolygons(const SafeKey& key) {
  if (key.bow != KeyBow::kButterfly) return {BowOutline(key)};
  const double waist = 0.1 * key.bow_height_m;
  const double depth = 0.3 * key.bow_depth_m;
  std::vector<Polygon> bow = {BoxPolygon({-waist, -depth}, {waist, depth})};
  for (const double side : {-1.0, 1.0}) {
    Polygon wing;
    const Eigen::Vector2d half(0.21 * key.bow_height_m, key.bow_depth_m / 2);
    for (const Eigen::Vector2d& p : CirclePolygon({0, 0}, 1, 20))
      wing.emplace_back(p.cwiseProduct(half) + Eigen::Vector2d(side * 0.29 * key.bow_height_m, 0));
    const Eigen::Vector2d inwards(-side, 0);
    bow.push_back(Clipped(wing, {side * (waist + kSafeHandleJointM), 0}, inwards));
  }
  return bow;
}

Part BuildKey(const nlohmann::ordered_json& json, const std::string& path) {
  const auto key = ReadParameters<SafeKey>(json, path);
  RequireRange(path, "bow_height_m", key.bow_height_m, 0.024, 0.06);
  RequireRange(path, "bow_depth_m", key.bow_depth_m, 0.022, 0.05);
  RequireRange(path, "bow_thickness_m", key.bow_thickness_m, 0.003, 0.014);
  RequireRange(path, "barrel_radius_m", key.barrel_radius_m, 0.008, 0.03);
  RequireRange(path, "barrel_m", key.barrel_m, 0.004, 0.02);
  const double plate_m = key.plate.thickness_m * (key.plate.stepped ? 1.5 : 1);
  const double barrel_end = plate_m + key.barrel_m;
  RequireRange(path, "reach_m", key.reach_m, barrel_end + 0.006 + key.bow_depth_m / 2, 0.07);
  Part part;
  const double r = key.barrel_radius_m;
  AddPlate(key.plate, path + ".plate",
           {Lathed({{0, 1.25 * r},
                    {0.003, 1.2 * r},
                    {0.004, r},
                    {key.barrel_m - 0.001, r},
                    {key.barrel_m, r - 0.001}})},
           part);
  const double half = key.bow_thickness_m / 2;
  const double bow_begin =
      key.reach_m - key.bow_depth_m * (key.bow == KeyBow::kButterfly ? 0.3 : 0.5);
  const double shaft = 0.55 * half + 0.0015;
  std::vector<Solid> solids = {Lathed(
      {{barrel_end + 4 * kSafeHandleJointM, shaft}, {bow_begin - 2 * kSafeHandleJointM, shaft}},
      16)};
  for (Polygon bow : BowPolygons(key)) {
    for (Eigen::Vector2d& p : bow) p.y() += key.reach_m;
    solids.push_back(ConvexPrism(bow, PrismAxis::kY, {-half, half}, 0.3 * half));
  }
  part.pieces.push_back(MakePiece("grip", Joined(solids), key.finish, path + ".finish"));
  part.joint = HandleJoint(true);
  part.part_from_grasp = GraspAt({key.reach_m, 0, 0}, Closing::kHorizontal);
  part.grasp_half_extent_m = {0.2 * key.bow_height_m, 0.004, 0.2 * key.bow_depth_m};
  return part;
}

Part BuildSafeHandleTee(const nlohmann::ordered_json& json, const std::string& path) {
  const auto tee = ReadParameters<SafeTee>(json, path);
  Check(tee, path);
  CheckBall(tee, tee.ball_m, path);
  RequireRange(path, "sweep_m", tee.sweep_m, -0.01, 0.016);
  RequireRange(path, "vee_m", tee.vee_m, -0.03, 0.03);
  Part part;
  const double start = AddPlate(tee.plate, path + ".plate", {}, part);
  const double half = tee.length_m / 2 - (tee.ball_m > 0 ? tee.ball_m - 0.004 : 0);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= 12; ++i) {
    const double t = -1 + i / 6.0;
    points.emplace_back(tee.projection_m - tee.sweep_m * t * t, -half * t, tee.vee_m * t * t);
  }
  const auto section = [&](double fraction) {
    const double away = std::abs(2 * fraction - 1);
    const double scale = 1 + (tee.tip_scale - 1) * away;
    return Section{tee.bar_width_m / 2 * scale, tee.bar_depth_m / 2 * scale, tee.squareness};
  };
  const Eigen::Vector3d first = (points[1] - points[0]).normalized();
  const Eigen::Vector3d last = (points[12] - points[11]).normalized();
  const auto rings =
      SweepRings(SmoothPath(points, first, last), Eigen::Vector3d::UnitX(), section, 0.004);
  std::vector<Solid> solids = {LoftSolid(rings, kSafeHandleHullToleranceM)};
  if (tee.ball_m > 0) {
    const double away = 0.004 + kSafeHandleJointM + tee.ball_m / 2;
    solids.push_back(Ball(points[0] - away * first, tee.ball_m / 2));
    solids.push_back(Ball(points[12] + away * last, tee.ball_m / 2));
  }
  const double neck = tee.hub_diameter_m / 2;
  const double end = tee.projection_m - tee.bar_depth_m / 2 - kSafeHandleJointM;
  solids.push_back(Lathed({{start, 1.3 * neck},
                           {start + 0.3 * (end - start), neck},
                           {end, std::min(neck, 0.8 * tee.bar_width_m)}}));
  const GripParts grip{solids,
                       {tee.projection_m, 0, 0},
                       Eigen::Vector3d::UnitZ(),
                       {0.006, 0.004, tee.bar_depth_m / 2}};
  return Finished(std::move(part), grip, tee, path);
}

GripParts EllGrip(const SafeEll& ell, double start) {
  std::vector<Solid> solids = Arm(ell, DirectionAt(0), 0, ell.ball_m);
  solids.push_back(Hub(ell.hub_diameter_m / 2, start, ell.projection_m + 0.7 * ell.bar_depth_m));
  if (ell.post_m > 0) {
    // on the bar, near its tip
    const double r = 0.42 * ell.bar_width_m * std::min(1.0, ell.tip_scale);
    const double x = ell.projection_m + ell.bar_depth_m / 2 * std::max(1.0, ell.tip_scale);
    const Eigen::Vector3d at = DirectionAt(0) * (ell.length_m - 1.6 * r);
    solids.push_back(Moved(Lathed({{x + kSafeHandleJointM, 0.8 * r},
                                   {x + 0.3 * ell.post_m, 0.7 * r},
                                   {x + 0.7 * ell.post_m, 1.25 * r},
                                   {x + ell.post_m, 0.8 * r}},
                                  20),
                           at));
  }
  return {solids,
          {ell.projection_m, -0.6 * ell.length_m, 0},
          Eigen::Vector3d::UnitZ(),
          {0.12 * ell.length_m, 0.004, ell.bar_depth_m / 2 + 0.002}};
}

Part BuildEll(const nlohmann::ordered_json& json, const std::string& path) {
  const auto ell = ReadParameters<SafeEll>(json, path);
  Check(ell, path);
  CheckBall(ell, ell.ball_m, path);
  if (ell.post_m > 0) {
    RequireRange(path, "post_m", ell.post_m, 0.012, 0.03);
    RequireRange(path, "ball_m (with a post)", ell.ball_m, 0, 0);
  }
  Part part;
  const double start = AddPlate(ell.plate, path + ".plate", {}, part);
  return Finished(std::move(part), EllGrip(ell, start), ell, path);
}

// The dial stands still on the leaf, above the lever.
Part BuildDialLever(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<SafeDialLever>(json, path);
  Check(lever, path);
  CheckBall(lever, lever.ball_m, path);
  RequireRange(path, "dial_diameter_m", lever.dial_diameter_m, 0.04, 0.08);
  const double plate = std::max(lever.plate.width_m, lever.plate.height_m) / 2;
  RequireRange(path, "dial_height_m", lever.dial_height_m,
               plate + lever.dial_diameter_m / 2 + 0.004, 0.13);
  RequireRange(path, "dial_shift_m", lever.dial_shift_m, -0.06, 0.06);
  Part part;
  const double r = lever.dial_diameter_m / 2;
  const Solid numbered = Lathed({{0, r}, {0.004, r}, {0.0075, 0.8 * r}, {0.008, 0.78 * r}}, 40);
  const Solid knob =
      Moved(LatheSolid({{0, 0.5 * r}, {0.004, 0.55 * r}, {0.018, 0.5 * r}, {0.02, 0.42 * r}},
                       {48, 0.0012, 12}),
            {0.008 + kSafeHandleJointM, 0, 0});
  const double down = -lever.plate.thickness_m * (lever.plate.stepped ? 1.5 : 1) -
                      (lever.plate.stepped ? 2 : 1) * kSafeHandleJointM;
  const Solid dial =
      Moved(Joined({numbered, knob}), {down, lever.dial_shift_m, lever.dial_height_m});
  const double start = AddPlate(lever.plate, path + ".plate", {dial}, part);
  return Finished(std::move(part), EllGrip(lever, start), lever, path);
}

Part BuildSpokes(const nlohmann::ordered_json& json, const std::string& path) {
  const auto valve = ReadParameters<SafeSpokes>(json, path);
  Check(valve, path);
  CheckBall(valve, valve.ball_m, path);
  RequireRange(path, "spokes", valve.spokes, 2, 6);
  RequireRange(path, "dish_m", valve.dish_m, -0.01, 0.016);
  Part part;
  const double start = AddPlate(valve.plate, path + ".plate", {}, part);
  std::vector<Solid> solids = {
      Hub(valve.hub_diameter_m / 2, start, valve.projection_m + 0.8 * valve.bar_depth_m)};
  for (int i = 0; i < valve.spokes; ++i) {
    const std::vector<Solid> arm = Arm(valve, DirectionAt(2 * std::numbers::pi * i / valve.spokes),
                                       valve.dish_m, valve.ball_m);
    solids.insert(solids.end(), arm.begin(), arm.end());
  }
  const GripParts grip{solids,
                       {valve.projection_m + 0.6 * valve.dish_m, -0.62 * valve.length_m, 0},
                       Eigen::Vector3d::UnitZ(),
                       {0.12 * valve.length_m, 0.004, valve.bar_depth_m / 2 + 0.002}};
  return Finished(std::move(part), grip, valve, path);
}

// The rim is pinched midway between two spokes.
Part BuildWheel(const nlohmann::ordered_json& json, const std::string& path) {
  const auto wheel = ReadParameters<SafeWheel>(json, path);
  Check(wheel, path);
  RequireRange(path, "spokes", wheel.spokes, 3, 6);
  RequireRange(path, "length_m (radius of the rim)", wheel.length_m, 0.06, 0.119);
  RequireRange(path, "over_m", wheel.over_m, 0, 0.04);
  RequireRange(path, "dish_m", wheel.dish_m, -0.012, 0.02);
  RequireRange(path, "rim_width_m", wheel.rim_width_m, 0.01, 0.024);
  RequireRange(path, "rim_depth_m", wheel.rim_depth_m, 0.01, 0.024);
  Part part;
  const double start = AddPlate(wheel.plate, path + ".plate", {}, part);
  const double x = wheel.projection_m;
  const HoopShape rim{wheel.length_m, wheel.rim_width_m / 2, wheel.rim_depth_m / 2, 2, 48};
  const double hub_x = x - wheel.dish_m;
  std::vector<Solid> solids = {
      Hub(wheel.hub_diameter_m / 2, start, hub_x + 0.8 * wheel.bar_depth_m),
      HoopSolid(rim, {x, 0, 0})};
  for (int i = 0; i < wheel.spokes; ++i) {
    const Eigen::Vector3d direction = DirectionAt(2 * std::numbers::pi * (i + 0.5) / wheel.spokes);
    const Eigen::Vector3d at(x, 0, 0);
    const auto along = [&](double from) { return at + direction * (wheel.length_m + from); };
    const double border = wheel.rim_width_m / 2 + kSafeHandleJointM;
    solids.push_back(Bar(
        wheel,
        Eigen::Vector3d(hub_x, 0, 0) + direction * (wheel.hub_diameter_m / 2 + kSafeHandleJointM),
        along(-border), false));
    if (wheel.over_m > 0)
      solids.push_back(Bar(wheel, along(border), along(border + wheel.over_m), true));
  }
  const GripParts grip{solids,
                       Eigen::Vector3d(x, 0, 0) + wheel.length_m * DirectionAt(0),
                       Eigen::Vector3d::UnitY(),
                       {0.006, 0.004, wheel.rim_depth_m / 2}};
  return Finished(std::move(part), grip, wheel, path);
}

}  // namespace

std::span<const Family> SafeHandleFamilies() {
  static const Family kFamilies[] = {
      {"safe_key", PartRole::kHandle, Mechanism::kKey, BuildKey},
      {"safe_tee", PartRole::kHandle, Mechanism::kKey, BuildSafeHandleTee},
      {"safe_ell", PartRole::kHandle, Mechanism::kValve, BuildEll},
      {"safe_dial_lever", PartRole::kHandle, Mechanism::kValve, BuildDialLever},
      {"safe_spokes", PartRole::kHandle, Mechanism::kValve, BuildSpokes},
      {"safe_wheel", PartRole::kHandle, Mechanism::kValve, BuildWheel},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
