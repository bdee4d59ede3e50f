// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "doorforge/parts/mechanism.h"
#include "doorforge/solids/prism.h"
#include "doorforge/solids/sweep.h"

#include "handles/handle_base.h"

namespace doorforge::internal {
namespace {

constexpr double kCarHandleHullToleranceM = 0.0015;
constexpr double kCarHandleJointM = 0.0005;  // between grip and what is fixed
constexpr double kGraspShare = 0.47;         // of the length, from the axis
constexpr double kPivotM = 0.012;            // how far from its axis a grip is held

/// What all car handles share: a grip that reaches from an upright axis towards the free edge.
struct CarHandle {
  double length_m = 0.2;
  double height_m = 0.026;      ///< The grip has it along z; the fingers close across it.
  double depth_m = 0.012;       ///< The grip has it along x.
  double projection_m = 0.034;  ///< From the leaf to the grip's centre line.
  double squareness = 3;        ///< Exponent of the section.
  double tip_scale = 1;         ///< Height at the free end relative to the axis.
  double base_m = 0.006;        ///< Thickness of what lies on the leaf.
  std::string base_finish = "black_plastic";
  std::string finish = "polished_chrome";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("length_m", self.length_m);
    visit("height_m", self.height_m);
    visit("depth_m", self.depth_m);
    visit("projection_m", self.projection_m);
    visit("squareness", self.squareness);
    visit("tip_scale", self.tip_scale);
    visit("base_m", self.base_m);
    visit("base_finish", self.base_finish);
    visit("finish", self.finish);
  }
};

/// A pocket's rim or a flap's bezel.
struct FramedCarHandle : CarHandle {
  double frame_height_m = 0.06;
  double corner_radius_m = 0.02;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    CarHandle::VisitFields(self, visit);
    visit("frame_height_m", self.frame_height_m);
    visit("corner_radius_m", self.corner_radius_m);
  }
};

struct GrabHandle : CarHandle {
  double corner_radius_m = 0.014;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    CarHandle::VisitFields(self, visit);
    visit("corner_radius_m", self.corner_radius_m);
  }
};

void Check(const CarHandle& handle, const std::string& path) {
  RequireRange(path, "length_m", handle.length_m, 0.18, 0.205);
  RequireRange(path, "height_m", handle.height_m, 0.01, 0.054);
  RequireRange(path, "depth_m", handle.depth_m, 0.007, 0.022);
  RequireRange(path, "projection_m", handle.projection_m, 0.024, 0.046);
  RequireRange(path, "squareness", handle.squareness, 2, 10);
  RequireRange(path, "tip_scale", handle.tip_scale, 0.4, 1.6);
  RequireRange(path, "base_m", handle.base_m, 0.003, 0.012);
}

void CheckFrame(const FramedCarHandle& handle, const std::string& path) {
  RequireRange(path, "frame_height_m", handle.frame_height_m, handle.height_m + 0.004, 0.074);
  RequireRange(path, "corner_radius_m", handle.corner_radius_m, 0.006,
               handle.frame_height_m / 2 - 0.004);
}

// About -z: the free end comes out of the leaf.
PartJoint FlapJoint() {
  return {Eigen::Vector3d::Zero(), -Eigen::Vector3d::UnitZ(), 0, HandleRange(Category::kCar)};
}

Eigen::Vector3d LineAtY(const std::vector<PathPoint>& line, double y) {
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Eigen::Vector3d& a = line[i - 1].position_m;
    const Eigen::Vector3d& b = line[i].position_m;
    if (b.y() < y || b.y() <= a.y()) continue;
    return a + (b - a) * ((y - a.y()) / (b.y() - a.y()));
  }
  return line.back().position_m;
}

// A grip along a line, and the grasp on it.
void AddGrip(const CarHandle& handle, const std::string& path, const std::vector<PathPoint>& line,
             double dome_m, Part& part) {
  const auto section = [&](double fraction) {
    const double scale = 1 + (handle.tip_scale - 1) * fraction;
    return Section{handle.depth_m / 2, handle.height_m / 2 * scale, handle.squareness};
  };
  const auto rings = SweepRings(line, Eigen::Vector3d::UnitZ(), section, dome_m);
  part.pieces.push_back(MakePiece("grip", LoftSolid(rings, kCarHandleHullToleranceM), handle.finish,
                                  path + ".finish"));
  part.joint = FlapJoint();
  part.part_from_grasp = GraspAt(LineAtY(line, kGraspShare * handle.length_m), Closing::kVertical);
  part.grasp_half_extent_m = {0.12 * handle.length_m, 0.004, handle.depth_m / 2 + 0.002};
}

void AddBase(const CarHandle& handle, const std::string& path, const Solid& solid, Part& part) {
  part.pieces.push_back(MakePiece("rose", solid, handle.base_finish, path + ".base_finish"));
}

// A rounded pad on the leaf around (y, 0).
Solid Pad(const CarHandle& handle, double y, double half_length_m, double height_m) {
  const double half = height_m / 2;
  const double corner = std::min(half, half_length_m) * 0.9;
  return PlateSolid({{half_length_m, half}, corner, handle.base_m, handle.base_m * 0.35}, {y, 0});
}

Solid PadsAtEnds(const CarHandle& handle) {
  const double half = 0.02;
  const double height = handle.height_m * std::max(1.0, handle.tip_scale) + 0.012;
  return Joined({Pad(handle, kPivotM + 0.002, half, height),
                 Pad(handle, handle.length_m - half + 0.004, half, height)});
}

// A bow between two pads.
Part BuildStrap(const nlohmann::ordered_json& json, const std::string& path) {
  const auto handle = ReadParameters<CarHandle>(json, path);
  Check(handle, path);
  Part part;
  AddBase(handle, path, PadsAtEnds(handle), part);
  const double start = handle.base_m + kCarHandleJointM;
  const double end = handle.length_m - kPivotM;
  std::vector<Eigen::Vector3d> points;
  constexpr int kSteps = 24;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = std::numbers::pi * i / kSteps;
    points.emplace_back(start + (handle.projection_m - start) * std::pow(std::sin(angle), 0.6),
                        (kPivotM + end) / 2 - (end - kPivotM) / 2 * std::cos(angle), 0);
  }
  AddGrip(handle, path, SmoothPath(points, Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitX()), 0,
          part);
  return part;
}

// A straight bar on two legs.
Part BuildGrab(const nlohmann::ordered_json& json, const std::string& path) {
  const auto handle = ReadParameters<GrabHandle>(json, path);
  Check(handle, path);
  RequireRange(path, "corner_radius_m", handle.corner_radius_m, handle.depth_m / 2 + 0.001, 0.026);
  Part part;
  AddBase(handle, path, PadsAtEnds(handle), part);
  const double start = handle.base_m + kCarHandleJointM;
  const double end = handle.length_m - kPivotM;
  const double x = handle.projection_m;
  AddGrip(handle, path,
          FilletedPath(
              {{start, kPivotM, 0}, {x, kPivotM, 0}, {x, 0.09, 0}, {x, end, 0}, {start, end, 0}},
              handle.corner_radius_m),
          0, part);
  return part;
}

// A bar that only the axis holds.
Part BuildPull(const nlohmann::ordered_json& json, const std::string& path) {
  const auto handle = ReadParameters<GrabHandle>(json, path);
  Check(handle, path);
  RequireRange(path, "corner_radius_m", handle.corner_radius_m, handle.depth_m / 2 + 0.001, 0.026);
  Part part;
  AddBase(handle, path, Pad(handle, kPivotM, 0.026, handle.height_m + 0.016), part);
  const double x = handle.projection_m;
  const double dome = 0.4 * std::min(handle.depth_m, handle.height_m);
  AddGrip(handle, path,
          FilletedPath({{handle.base_m + kCarHandleJointM, kPivotM, 0},
                        {x, kPivotM, 0},
                        {0.92 * x, handle.length_m - dome, 0}},
                       handle.corner_radius_m),
          dome, part);
  return part;
}

// A blade that rises from a bezel towards its free end.
Part BuildFlap(const nlohmann::ordered_json& json, const std::string& path) {
  const auto handle = ReadParameters<FramedCarHandle>(json, path);
  Check(handle, path);
  CheckFrame(handle, path);
  Part part;
  const double half_length = (handle.length_m + 0.01) / 2;
  AddBase(handle, path,
          PlateSolid({{half_length, handle.frame_height_m / 2},
                      handle.corner_radius_m,
                      handle.base_m,
                      handle.base_m * 0.35},
                     {half_length - 0.006, 0}),
          part);
  const double start = handle.base_m + kCarHandleJointM + handle.depth_m / 2;
  std::vector<Eigen::Vector3d> points;
  constexpr int kSteps = 10;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps;
    const double rise =
        std::sin(std::numbers::pi / 2 * std::min(1.0, 2.2 * t)) * (1 - 0.15 * t * t);
    points.emplace_back(start + (handle.projection_m - start) * rise,
                        0.002 + t * (handle.length_m - 0.006), 0);
  }
  AddGrip(handle, path, SmoothPath(points, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitY()),
          0.3 * handle.depth_m, part);
  return part;
}

// A bar across a cup.
Part BuildPocket(const nlohmann::ordered_json& json, const std::string& path) {
  const auto handle = ReadParameters<FramedCarHandle>(json, path);
  Check(handle, path);
  CheckFrame(handle, path);
  Part part;
  const double rim = 0.007;
  const Eigen::Vector2d low(-0.008, -handle.frame_height_m / 2);
  const Eigen::Vector2d high(handle.length_m, handle.frame_height_m / 2);
  const auto box = [&](double inset, double radius) {
    return RoundedBoxPolygon(low.array() + inset, high.array() - inset, radius);
  };
  CupShape cup;
  cup.outer = box(0, handle.corner_radius_m);
  cup.inner = box(rim, std::max(0.004, handle.corner_radius_m - rim));
  cup.outer_hull = RoundedRectangle((high - low) / 2, handle.corner_radius_m, 3);
  cup.inner_hull = RoundedRectangle((high - low) / 2 - Eigen::Vector2d::Constant(rim),
                                    std::max(0.004, handle.corner_radius_m - rim), 2);
  for (Polygon* polygon : {&cup.outer_hull, &cup.inner_hull}) {
    for (Eigen::Vector2d& p : *polygon) p += (low + high) / 2;
  }
  cup.back_x_m = 0;
  cup.floor_x_m = 0.004;
  cup.front_x_m = handle.base_m + 0.004;
  cup.edge_radius_m = 0.002;
  AddBase(handle, path, CupSolid(cup), part);
  const double start = cup.floor_x_m + kCarHandleJointM;
  const double x = handle.projection_m;
  const double end = handle.length_m - 0.02;
  AddGrip(handle, path,
          FilletedPath({{start, kPivotM + 0.006, 0},
                        {x, kPivotM + 0.006, 0},
                        {x, 0.09, 0},
                        {0.96 * x, end, 0},
                        {start, end, 0}},
                       handle.depth_m / 2 + 0.004),
          0, part);
  return part;
}

}  // namespace

std::span<const Family> CarHandleFamilies() {
  static const Family kFamilies[] = {
      {"car_strap", PartRole::kHandle, Mechanism::kFlap, BuildStrap},
      {"car_grab", PartRole::kHandle, Mechanism::kFlap, BuildGrab},
      {"car_pull", PartRole::kHandle, Mechanism::kFlap, BuildPull},
      {"car_flap", PartRole::kHandle, Mechanism::kFlap, BuildFlap},
      {"car_pocket", PartRole::kHandle, Mechanism::kFlap, BuildPocket},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
