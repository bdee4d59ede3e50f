// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "handles/lever_base.h"

namespace doorforge::internal {
namespace {

struct ScrollLever : Lever {
  double curl_radius_m = 0.013;
  double curl_turn_rad = 4.0;
  bool upwards = false;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Lever::VisitFields(self, visit);
    visit("curl_radius_m", self.curl_radius_m);
    visit("curl_turn_rad", self.curl_turn_rad);
    visit("upwards", self.upwards);
  }
};

struct SquareLever : Lever {
  double return_m = 0;  ///< Length of a mitred end towards the leaf; 0: none.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Lever::VisitFields(self, visit);
    visit("return_m", self.return_m);
  }
};

/// Outline of a blade, seen from the front.
enum class BladeForm {
  kTapered,  ///< Its ends are round.
  kSquare,
  kLeaf,  ///< It is widest in the middle.
};
inline constexpr NamedValue<BladeForm> kBladeFormWords[] = {
    {BladeForm::kTapered, "tapered"}, {BladeForm::kSquare, "square"}, {BladeForm::kLeaf, "leaf"}};
constexpr std::span<const NamedValue<BladeForm>> ValuesOf(BladeForm) { return kBladeFormWords; }

struct BladeLever : Lever {
  double root_height_m = 0.036;  ///< The blade has it at the handle's axis.
  double tip_height_m = 0.022;
  BladeForm outline = BladeForm::kTapered;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Lever::VisitFields(self, visit);
    visit("root_height_m", self.root_height_m);
    visit("tip_height_m", self.tip_height_m);
    visit("outline", self.outline);
  }
};

struct CrankedLever : Lever {
  double crank_m = 0.018;       ///< How far the outer part lies above (below if negative) the axis.
  double crank_at_m = 0.035;    ///< Where the step begins, from the axis.
  double crank_width_m = 0.02;  ///< The step has it along y.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Lever::VisitFields(self, visit);
    visit("crank_m", self.crank_m);
    visit("crank_at_m", self.crank_at_m);
    visit("crank_width_m", self.crank_width_m);
  }
};

// A straight bar whose end curls in the plane of the leaf, ever tighter.
std::vector<PathPoint> ScrollPath(const ScrollLever& lever, double start_x) {
  const double x = lever.projection_m;
  const double bar_end = lever.length_m - lever.curl_radius_m - lever.bar_height_m / 2;
  std::vector<PathPoint> path =
      FilletedPath({{start_x, 0, 0}, {x, 0, 0}, {x, -bar_end, 0}}, lever.bend_radius_m);
  const int steps = static_cast<int>(std::ceil(lever.curl_turn_rad / 0.25));
  const double step = lever.curl_turn_rad / steps;
  const double side = lever.upwards ? 1 : -1;
  Eigen::Vector3d at = path.back().position_m;
  double length = path.back().length_m;
  for (int i = 1; i <= steps; ++i) {
    const double turn = step * i;
    const double radius = lever.curl_radius_m * (1 - 0.3 * turn / lever.curl_turn_rad);
    const double chord = 2 * radius * std::sin(step / 2);
    const double middle = turn - step / 2;
    at += chord * Eigen::Vector3d(0, -std::cos(middle), side * std::sin(middle));
    length += chord;
    path.push_back({at, {0, -std::cos(turn), side * std::sin(turn)}, length});
  }
  return path;
}

Part BuildScroll(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<ScrollLever>(json, path);
  CheckLever(lever, path);
  const double half_tip = lever.bar_height_m / 2 * lever.tip_scale;
  RequireRange(path, "curl_radius_m", lever.curl_radius_m, half_tip / 0.7 + 0.001, 0.022);
  RequireRange(path, "curl_turn_rad", lever.curl_turn_rad, 1.5, 4.4);
  return LeverPart(lever, path, [&](double start_x) { return ScrollPath(lever, start_x); });
}

// Rings of a rectangular bar with sharp mitres: square neck, bar, and an end towards the leaf.
std::vector<Ring> MitredRings(const SquareLever& lever, double start_x) {
  const double x = lever.projection_m;
  const double depth = lever.bar_depth_m;
  const Eigen::Vector3d in = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d along = -Eigen::Vector3d::UnitY();
  const double end_y = -lever.length_m;
  std::vector<PathPoint> path = {{{start_x, 0, 0}, in}, {{x, 0, 0}, (in + along).normalized()}};
  if (lever.return_m > 0) {
    path.push_back({{x, end_y + depth / 2, 0}, (along - in).normalized()});
    path.push_back({{x - lever.return_m, end_y + depth / 2, 0}, -in});
  } else {
    path.push_back({{x, end_y + 0.001, 0}, along});
  }
  for (std::size_t i = 1; i < path.size(); ++i)
    path[i].length_m = path[i - 1].length_m + (path[i].position_m - path[i - 1].position_m).norm();
  const double total = path.back().length_m;
  const auto section = [&](double fraction) {
    const bool mitre = std::any_of(path.begin(), path.end(), [&](const PathPoint& p) {
      return std::abs(p.tangent.x() * p.tangent.y()) > 0.1 &&
             std::abs(p.length_m / total - fraction) < 1e-9;
    });
    const double scale = 1 + (lever.tip_scale - 1) * fraction;
    return Section{depth / 2 * (mitre ? std::numbers::sqrt2 : 1), lever.bar_height_m / 2 * scale,
                   lever.squareness};
  };
  return TransportedSweepRings(path, Eigen::Vector3d::UnitZ(), section, 0.001);
}

Part BuildSquare(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<SquareLever>(json, path);
  CheckLever(lever, path);
  RequireRange(path, "return_m", lever.return_m, 0, lever.projection_m - 0.02);
  Part part;
  const double start_x = AddRose(lever.rose, path + ".rose", part);
  const Solid bar = LoftSolid(MitredRings(lever, start_x), kLeverHullToleranceM);
  part.pieces.push_back(MakePiece("grip", bar, lever.finish, path + ".finish"));
  FinishLever(lever, {lever.projection_m, -0.57 * lever.length_m, 0}, part);
  return part;
}

// Half the blade's height at fraction t from behind the axis to the tip.
double BladeHalfHeight(const BladeLever& lever, double t) {
  const double root = lever.root_height_m / 2;
  const double tip = lever.tip_height_m / 2;
  if (lever.outline == BladeForm::kLeaf)
    return tip + (root - tip) * std::sin(std::numbers::pi * (0.08 + 0.84 * t));
  return root + (tip - root) * t;
}

// The blade's outline in the plane of the leaf, counter-clockwise as seen from the front.
std::vector<Eigen::Vector2d> BladeOutline(const BladeLever& lever, double inset_m) {
  const bool square = lever.outline == BladeForm::kSquare;
  const double root = BladeHalfHeight(lever, 0) - inset_m;
  const double tip = BladeHalfHeight(lever, 1) - inset_m;
  // round ends bulge by their own half height
  const double from = square ? lever.neck_diameter_m / 2 + 0.003 - inset_m : 0.0;
  const double to = square ? -lever.length_m + inset_m : -lever.length_m + tip + inset_m;
  constexpr int kSteps = 8;
  std::vector<Eigen::Vector2d> outline;
  const auto end = [&](double y, double radius, double first) {
    for (int i = 1; !square && i < 6; ++i) {
      const double angle = first + std::numbers::pi * i / 6;
      outline.emplace_back(y + radius * std::cos(angle), radius * std::sin(angle));
    }
  };
  for (int i = 0; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps;
    outline.emplace_back(from + (to - from) * t, BladeHalfHeight(lever, t) - inset_m);
  }
  end(to, tip, std::numbers::pi / 2);
  for (int i = kSteps; i >= 0; --i) {
    const double t = static_cast<double>(i) / kSteps;
    outline.emplace_back(from + (to - from) * t, inset_m - BladeHalfHeight(lever, t));
  }
  end(from, root, -std::numbers::pi / 2);
  return outline;
}

Solid BladeSolid(const BladeLever& lever) {
  const double back = lever.projection_m - lever.bar_depth_m / 2;
  const double front = lever.projection_m + lever.bar_depth_m / 2;
  const auto ring = [&](double x, double inset) {
    Ring points;
    for (const Eigen::Vector2d& p : BladeOutline(lever, inset))
      points.emplace_back(x, p.x(), p.y());
    return points;
  };
  const double edge = 0.18 * lever.bar_depth_m;
  const std::vector<Ring> rings = {ring(back, edge), ring(back + edge, 0), ring(front - edge, 0),
                                   ring(front - 0.3 * edge, 0.3 * edge), ring(front, edge)};
  return {Loft(rings), LoftHulls({ring(back, 0), ring(front, 0)}, 0.001)};
}

// A round neck out of the rose with a flat blade on its end.
Part BuildBlade(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<BladeLever>(json, path);
  CheckLever(lever, path);
  RequireRange(path, "root_height_m", lever.root_height_m, 0.016, 0.056);
  RequireRange(path, "tip_height_m", lever.tip_height_m, 0.012, 0.056);
  Part part;
  const double start_x = AddRose(lever.rose, path + ".rose", part);
  const double back = lever.projection_m - lever.bar_depth_m / 2;
  const double neck = lever.neck_diameter_m / 2;
  const Solid neck_solid = LatheSolid(
      {{start_x, 1.25 * neck}, {start_x + 0.2 * (back - start_x), neck}, {back, neck}}, {});
  part.pieces.push_back(
      MakePiece("grip", Joined({neck_solid, BladeSolid(lever)}), lever.finish, path + ".finish"));
  FinishLever(lever, {lever.projection_m, -0.57 * lever.length_m, 0}, part);
  return part;
}

// The bar steps up or down in the plane of the leaf.
Part BuildCranked(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<CrankedLever>(json, path);
  CheckLever(lever, path);
  RequireRange(path, "crank_m", std::abs(lever.crank_m), 0.004, 0.032);
  RequireRange(path, "crank_at_m", lever.crank_at_m, 2.1 * lever.bend_radius_m, 0.05);
  RequireRange(path, "crank_width_m", lever.crank_width_m, 0.6 * std::abs(lever.crank_m), 0.035);
  const double x = lever.projection_m;
  const double y = -lever.crank_at_m;
  const double z = lever.crank_m;
  return LeverPart(lever, path, [&](double start_x) {
    return FilletedPath({{start_x, 0, 0},
                         {x, 0, 0},
                         {x, y, 0},
                         {x, y - lever.crank_width_m, z},
                         {x, -lever.length_m, z}},
                        lever.bend_radius_m);
  });
}

}  // namespace

std::span<const Family> ShapedLeverFamilies() {
  static const Family kFamilies[] = {
      {"lever_scroll", PartRole::kHandle, Mechanism::kLever, BuildScroll},
      {"lever_square", PartRole::kHandle, Mechanism::kLever, BuildSquare},
      {"lever_blade", PartRole::kHandle, Mechanism::kLever, BuildBlade},
      {"lever_cranked", PartRole::kHandle, Mechanism::kLever, BuildCranked},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
