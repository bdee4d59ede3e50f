// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "doorforge/solids/prism.h"
#include "doorforge/solids/sweep.h"

#include "handles/handle_base.h"

namespace doorforge::internal {
namespace {

constexpr double kWindowHandleHullToleranceM = 0.0015;
constexpr double kWindowHandleJointM = 0.0002;  // between solids of one grip that touch

/// What all window handles share: an upright grip above the axis, on a neck out of a rose.
struct WindowHandle {
  double length_m = 0.115;      ///< From the axis to the tip, along z.
  double projection_m = 0.045;  ///< From the leaf to the grip's centre line.
  double width_m = 0.016;       ///< The grip has it along y; the fingers close across it.
  double depth_m = 0.012;       ///< The grip has it along x.
  double squareness = 3;        ///< Exponent of the section.
  double tip_scale = 1;         ///< Width at the tip relative to the neck.
  double neck_diameter_m = 0.016;
  RoseParameters rose;
  std::string finish = "satin_aluminium";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("length_m", self.length_m);
    visit("projection_m", self.projection_m);
    visit("width_m", self.width_m);
    visit("depth_m", self.depth_m);
    visit("squareness", self.squareness);
    visit("tip_scale", self.tip_scale);
    visit("neck_diameter_m", self.neck_diameter_m);
    visit("rose", self.rose);
    visit("finish", self.finish);
  }
};

struct BentHandle : WindowHandle {
  double bend_radius_m = 0.016;
  double bow_m = 0;  ///< Outward bulge of the grip; negative bends towards the leaf.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    WindowHandle::VisitFields(self, visit);
    visit("bend_radius_m", self.bend_radius_m);
    visit("bow_m", self.bow_m);
  }
};

struct CockspurHandle : WindowHandle {
  double spur_m = 0.022;  ///< Length of the nose that holds the frame, from the axis along y.
  double hook_m = 0.01;   ///< How far the grip sways sideways.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    WindowHandle::VisitFields(self, visit);
    visit("spur_m", self.spur_m);
    visit("hook_m", self.hook_m);
  }
};

struct CrankHandle : WindowHandle {
  double knob_m = 0.024;        ///< Diameter of the knob at the arm's end.
  double knob_length_m = 0.03;  ///< Along x.
  int knob_sides = 24;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    WindowHandle::VisitFields(self, visit);
    visit("knob_m", self.knob_m);
    visit("knob_length_m", self.knob_length_m);
    visit("knob_sides", self.knob_sides);
  }
};

struct ScrollHandle : WindowHandle {
  double curl_m = 0.018;  ///< Outer radius of the curl at the tip.
  double turns = 1.2;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    WindowHandle::VisitFields(self, visit);
    visit("curl_m", self.curl_m);
    visit("turns", self.turns);
  }
};

struct LoopHandle : WindowHandle {
  double loop_width_m = 0.05;  ///< Between the outsides of the loop, along y.
  double roundness = 2;        ///< 2: oval; larger: a frame with rounded corners.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    WindowHandle::VisitFields(self, visit);
    visit("loop_width_m", self.loop_width_m);
    visit("roundness", self.roundness);
  }
};

struct DropHandle : WindowHandle {
  double bulge_m = 0.028;  ///< Largest diameter.
  double bulge_at = 0.7;   ///< Where, as a share of the length.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    WindowHandle::VisitFields(self, visit);
    visit("bulge_m", self.bulge_m);
    visit("bulge_at", self.bulge_at);
  }
};

void Check(const WindowHandle& handle, const std::string& path) {
  RequireRange(path, "length_m", handle.length_m, 0.05, 0.13);
  RequireRange(path, "projection_m", handle.projection_m, 0.026, 0.065);
  RequireRange(path, "width_m", handle.width_m, 0.006, 0.036);
  RequireRange(path, "depth_m", handle.depth_m, 0.006, 0.022);
  RequireRange(path, "squareness", handle.squareness, 2, 10);
  RequireRange(path, "tip_scale", handle.tip_scale, 0.5, 2);
  RequireRange(path, "neck_diameter_m", handle.neck_diameter_m, 0.01, 0.024);
}

// A grasp at a height, fingers closing sideways.
void SetGrasp(const WindowHandle& handle, const Eigen::Vector3d& at, Part& part) {
  part.joint = HandleJoint(true);
  part.part_from_grasp = GraspAt(at, Closing::kHorizontal);
  part.grasp_half_extent_m = {0.14 * handle.length_m, 0.004, handle.depth_m / 2 + 0.002};
}

void AddGrip(const WindowHandle& handle, const std::string& path, const Solid& solid, Part& part) {
  part.pieces.push_back(MakePiece("grip", solid, handle.finish, path + ".finish"));
}

// A round neck out of the rose up to `end_x`, a little thicker at its root.
Solid Neck(const WindowHandle& handle, double start_x, double end_x) {
  const double r = handle.neck_diameter_m / 2;
  return LatheSolid({{start_x, 1.15 * r}, {start_x + 0.2 * (end_x - start_x), r}, {end_x, r}}, {});
}

// Sections of a bar that runs in the plane of the leaf: u across it, v along x.
Section FlatSection(const WindowHandle& handle, double fraction) {
  const double scale = 1 + (handle.tip_scale - 1) * fraction;
  return {handle.width_m / 2 * scale, handle.depth_m / 2, handle.squareness};
}

// A bar through points in the plane of the leaf.
Solid FlatBar(const WindowHandle& handle, const std::vector<Eigen::Vector3d>& points,
              double dome_m) {
  const Eigen::Vector3d first = (points[1] - points[0]).normalized();
  const Eigen::Vector3d last = (points.back() - points[points.size() - 2]).normalized();
  const auto section = [&](double fraction) { return FlatSection(handle, fraction); };
  return LoftSolid(
      SweepRings(SmoothPath(points, first, last), Eigen::Vector3d::UnitX(), section, dome_m),
      kWindowHandleHullToleranceM);
}

// The end of a neck that carries a flat bar.
double BarBack(const WindowHandle& handle) {
  return handle.projection_m - handle.depth_m / 2 - kWindowHandleJointM;
}

Part BuildEspagnolette(const nlohmann::ordered_json& json, const std::string& path) {
  const auto handle = ReadParameters<BentHandle>(json, path);
  Check(handle, path);
  RequireRange(path, "bow_m", handle.bow_m, -0.01, 0.016);
  const double inner = std::max(handle.neck_diameter_m, handle.depth_m) / 2;
  RequireRange(path, "bend_radius_m", handle.bend_radius_m, inner + 0.001, 0.03);
  Part part;
  const double start_x = AddRose(handle.rose, path + ".rose", part);
  const double x = handle.projection_m;
  const double dome = 0.35 * std::min(handle.depth_m, handle.width_m);
  const double end = handle.length_m - dome;
  std::vector<PathPoint> line =
      FilletedPath({{start_x, 0, 0}, {x, 0, 0}, {x, 0, end}}, handle.bend_radius_m);
  const double total = line.back().length_m;
  line.pop_back();
  const double bend_end = line.back().length_m / total;
  const double bend_begin = bend_end - handle.bend_radius_m * std::numbers::pi / 2 / total;
  std::vector<Eigen::Vector3d> bar;
  for (int i = 0; i <= 10; ++i) {
    const double t = i / 10.0;
    const double bow = handle.bow_m * (0.5 - 0.5 * std::cos(2 * std::numbers::pi * t));
    bar.emplace_back(x + bow, 0, handle.bend_radius_m + t * (end - handle.bend_radius_m));
  }
  const double so_far = line.back().length_m;
  const auto upper = SmoothPath(bar, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ());
  for (std::size_t i = 1; i < upper.size(); ++i) {
    line.push_back(upper[i]);
    line.back().length_m += so_far;
  }
  const auto section = [&](double fraction) {
    const double t = std::clamp((fraction - bend_begin) / (bend_end - bend_begin), 0.0, 1.0);
    const double smooth = t * t * (3 - 2 * t);
    const double along = std::clamp((fraction - bend_end) / (1 - bend_end), 0.0, 1.0);
    const double neck = handle.neck_diameter_m / 2;
    const double width = handle.width_m / 2 * (1 + (handle.tip_scale - 1) * along);
    return Section{neck + (handle.depth_m / 2 - neck) * smooth, neck + (width - neck) * smooth,
                   2 + (handle.squareness - 2) * smooth};
  };
  AddGrip(handle, path,
          LoftSolid(SweepRings(line, Eigen::Vector3d::UnitY(), section, dome),
                    kWindowHandleHullToleranceM),
          part);
  SetGrasp(handle, {x + 0.9 * handle.bow_m, 0, 0.6 * handle.length_m}, part);
  return part;
}

Part BuildCockspur(const nlohmann::ordered_json& json, const std::string& path) {
  const auto handle = ReadParameters<CockspurHandle>(json, path);
  Check(handle, path);
  RequireRange(path, "spur_m", handle.spur_m, 0.012, 0.026);
  RequireRange(path, "hook_m", handle.hook_m, 0, 0.02);
  Part part;
  const double start_x = AddRose(handle.rose, path + ".rose", part);
  const double back = BarBack(handle);
  const double half = handle.neck_diameter_m / 2;
  // the nose lies on the neck, near the leaf
  const double nose_end = std::min(start_x + 0.012, back - 0.002);
  const Solid nose = ChamferedBox({start_x, -half - 0.002, -half - 0.002},
                                  {nose_end, handle.spur_m, half + 0.002}, 0.002);
  std::vector<Eigen::Vector3d> points;
  const double begin = -half - 0.004;
  const double end = handle.length_m - 0.004;
  for (int i = 0; i <= 14; ++i) {
    const double t = i / 14.0;
    const double sway =
        -handle.hook_m * (0.5 - 0.5 * std::cos(std::numbers::pi * std::min(1.0, 1.6 * t)));
    const double back_sway = 0.6 * handle.hook_m * std::pow(std::max(0.0, t - 0.5) * 2, 2);
    points.emplace_back(handle.projection_m, sway + back_sway, begin + t * (end - begin));
  }
  AddGrip(handle, path,
          Joined({nose, Neck(handle, nose_end + kWindowHandleJointM, back),
                  FlatBar(handle, points, 0.004)}),
          part);
  SetGrasp(handle, points[9], part);
  return part;
}

Part BuildCrank(const nlohmann::ordered_json& json, const std::string& path) {
  const auto handle = ReadParameters<CrankHandle>(json, path);
  Check(handle, path);
  RequireRange(path, "knob_m", handle.knob_m, 0.016, 0.034);
  RequireRange(path, "knob_length_m", handle.knob_length_m, 0.018, 0.036);
  RequireRange(path, "knob_sides", handle.knob_sides, 6, 32);
  Part part;
  const double start_x = AddRose(handle.rose, path + ".rose", part);
  const double radius = handle.knob_m / 2;
  const double top = handle.length_m - radius;
  const double half = handle.width_m / 2;
  const Solid arm = FlatBar(handle,
                            {{handle.projection_m, 0, -half},
                             {handle.projection_m, 0, top / 2},
                             {handle.projection_m, 0, top}},
                            0.5 * handle.width_m);
  const double length = handle.knob_length_m;
  const Solid knob = LatheSolid({{0, 0.5 * radius},
                                 {0.16 * length, 0.55 * radius},
                                 {0.3 * length, 0.92 * radius},
                                 {0.55 * length, radius},
                                 {0.85 * length, 0.95 * radius},
                                 {0.97 * length, 0.75 * radius},
                                 {length, 0.5 * radius}},
                                {handle.knob_sides, 0, 0});
  const double front = handle.projection_m + handle.depth_m / 2 + kWindowHandleJointM;
  AddGrip(handle, path,
          Joined({Neck(handle, start_x, BarBack(handle)), arm, Moved(knob, {front, 0, top})}),
          part);
  SetGrasp(handle, {front + 0.6 * length, 0, top}, part);
  part.grasp_half_extent_m = {0.004, 0.004, 0.2 * length};
  return part;
}

Part BuildWindowHandleTee(const nlohmann::ordered_json& json, const std::string& path) {
  const auto handle = ReadParameters<BentHandle>(json, path);
  Check(handle, path);
  RequireRange(path, "length_m", handle.length_m, 0.05, 0.078);
  RequireRange(path, "bow_m", handle.bow_m, -0.01, 0.016);
  Part part;
  const double start_x = AddRose(handle.rose, path + ".rose", part);
  // ends bend towards or away from the leaf
  std::vector<Eigen::Vector3d> points;
  const double end = handle.length_m - 0.004;
  for (int i = -8; i <= 8; ++i) {
    const double t = i / 8.0;
    points.emplace_back(handle.projection_m - handle.bow_m * t * t, 0, t * end);
  }
  const auto section = [&](double fraction) {
    return FlatSection(handle, std::abs(2 * fraction - 1));
  };
  const Solid bar = LoftSolid(SweepRings(SmoothPath(points, (points[1] - points[0]).normalized(),
                                                    (points[16] - points[15]).normalized()),
                                         Eigen::Vector3d::UnitX(), section, 0.004),
                              kWindowHandleHullToleranceM);
  AddGrip(handle, path, Joined({Neck(handle, start_x, BarBack(handle)), bar}), part);
  SetGrasp(handle, points[13], part);
  return part;
}

Part BuildWindowHandleScroll(const nlohmann::ordered_json& json, const std::string& path) {
  const auto handle = ReadParameters<ScrollHandle>(json, path);
  Check(handle, path);
  const double bar = handle.width_m * std::max(1.0, handle.tip_scale);
  RequireRange(path, "curl_m", handle.curl_m, 0.9 * bar + 0.004, 0.026);
  RequireRange(path, "turns", handle.turns, 0.5,
               0.5 + 0.8 * (handle.curl_m - 0.5 * bar) / (1.25 * bar));
  Part part;
  const double start_x = AddRose(handle.rose, path + ".rose", part);
  const double x = handle.projection_m;
  const double curl = handle.curl_m - bar / 2;
  const double top = handle.length_m - handle.curl_m;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 8; ++i)
    points.emplace_back(x, 0, -handle.width_m / 2 + i / 8.0 * (top + handle.width_m / 2));
  // a spiral to the hinge side that tightens by 1.25 bar widths a turn
  const int steps = static_cast<int>(std::ceil(24 * handle.turns));
  for (int i = 0; i <= steps; ++i) {
    const double turn = handle.turns * i / steps;
    const double radius = curl - 1.25 * bar * turn * 0.8;
    const double angle = 2 * std::numbers::pi * turn;
    points.emplace_back(x, -curl + radius * std::cos(angle), top + radius * std::sin(angle));
  }
  AddGrip(handle, path,
          Joined({Neck(handle, start_x, BarBack(handle)), FlatBar(handle, points, 0.003)}), part);
  SetGrasp(handle, {x, 0, 0.55 * top}, part);
  return part;
}

Part BuildLoop(const nlohmann::ordered_json& json, const std::string& path) {
  const auto handle = ReadParameters<LoopHandle>(json, path);
  Check(handle, path);
  RequireRange(path, "loop_width_m", handle.loop_width_m, 0.03, 0.068);
  RequireRange(path, "roundness", handle.roundness, 2, 6);
  RequireRange(path, "width_m", handle.width_m, 0.006, 0.3 * handle.loop_width_m);
  Part part;
  const double start_x = AddRose(handle.rose, path + ".rose", part);
  const double a = (handle.loop_width_m - handle.width_m) / 2;
  const double low = -handle.width_m / 2;
  const double b = (handle.length_m - handle.width_m / 2 - low) / 2;
  const auto at = [&](double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double r =
        std::pow(std::pow(std::abs(c), handle.roundness) + std::pow(std::abs(s), handle.roundness),
                 -1 / handle.roundness);
    return Eigen::Vector3d(handle.projection_m, a * r * c, low + b + b * r * s);
  };
  std::vector<PathPoint> line;
  constexpr int kSides = 40;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    line.push_back(
        {at(angle), (at(angle + 0.01) - at(angle - 0.01)).normalized(), static_cast<double>(i)});
  }
  WindowHandle plain = handle;
  plain.tip_scale = 1;
  std::vector<Ring> rings = SweepRings(
      line, Eigen::Vector3d::UnitX(), [&](double) { return FlatSection(plain, 0); }, 0);
  Solid loop{LoftLoop(rings), {}};
  rings.push_back(rings.front());
  loop.hulls = LoftHulls(rings, 0.0022);
  AddGrip(handle, path, Joined({Neck(handle, start_x, BarBack(handle)), loop}), part);
  SetGrasp(handle, {handle.projection_m, 0, low + b}, part);
  part.grasp_half_extent_m.x() = 0.1 * handle.length_m;
  return part;
}

Part BuildDrop(const nlohmann::ordered_json& json, const std::string& path) {
  const auto handle = ReadParameters<DropHandle>(json, path);
  Check(handle, path);
  RequireRange(path, "bulge_m", handle.bulge_m, handle.width_m, 0.044);
  RequireRange(path, "bulge_at", handle.bulge_at, 0.45, 0.85);
  RequireRange(path, "projection_m", handle.projection_m, handle.bulge_m / 2 + 0.016, 0.065);
  Part part;
  const double start_x = AddRose(handle.rose, path + ".rose", part);
  // a solid of revolution about the upright axis through the grip
  std::vector<Eigen::Vector3d> points;
  constexpr int kSteps = 18;
  const double stem = handle.width_m / 2;
  const double begin = -handle.neck_diameter_m / 2 - 0.003;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps;
    points.emplace_back(handle.projection_m, 0, begin + t * (handle.length_m - 0.003 - begin));
  }
  const auto section = [&](double fraction) {
    const double from = fraction - handle.bulge_at;
    const double spread = from < 0 ? 0.32 : (1 - handle.bulge_at) * 1.1;
    const double bell = std::exp(-std::pow(from / spread, 2) * 2);
    const double radius = stem + (handle.bulge_m / 2 - stem) * bell;
    return Section{radius, radius, handle.squareness};
  };
  const Solid drop =
      LoftSolid(SweepRings(SmoothPath(points, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitZ()),
                           Eigen::Vector3d::UnitX(), section, 0.003),
                kWindowHandleHullToleranceM);
  AddGrip(handle, path,
          Joined({Neck(handle, start_x, handle.projection_m - 1.15 * stem - kWindowHandleJointM),
                  drop}),
          part);
  SetGrasp(handle, {handle.projection_m, 0, handle.bulge_at * handle.length_m}, part);
  return part;
}

}  // namespace

std::span<const Family> WindowHandleFamilies() {
  static const Family kFamilies[] = {
      {"window_espagnolette", PartRole::kHandle, Mechanism::kLever, BuildEspagnolette},
      {"window_cockspur", PartRole::kHandle, Mechanism::kLever, BuildCockspur},
      {"window_crank", PartRole::kHandle, Mechanism::kLever, BuildCrank},
      {"window_tee", PartRole::kHandle, Mechanism::kLever, BuildWindowHandleTee},
      {"window_scroll", PartRole::kHandle, Mechanism::kLever, BuildWindowHandleScroll},
      {"window_loop", PartRole::kHandle, Mechanism::kLever, BuildLoop},
      {"window_drop", PartRole::kHandle, Mechanism::kLever, BuildDrop},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
