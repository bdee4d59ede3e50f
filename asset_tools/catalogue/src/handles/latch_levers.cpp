// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "doorforge/solids/sweep.h"

#include "handles/handle_base.h"

namespace doorforge::internal {
namespace {

constexpr double kLatchLeverHullToleranceM = 0.001;

/// The latch of an old refrigerator: a boss on an escutcheon and a blade that widens towards its
/// tip and springs away from the leaf.
struct LatchLever {
  double length_m = 0.1;        ///< From the axis to the tip.
  double projection_m = 0.038;  ///< From the leaf to the blade's root.
  double flare_m = 0.008;       ///< How much farther out the tip is.
  double root_height_m = 0.014;
  double tip_height_m = 0.024;
  double blade_depth_m = 0.009;
  double boss_diameter_m = 0.03;
  double squareness = 3;
  RoseParameters rose;
  std::string finish = "polished_chrome";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("length_m", self.length_m);
    visit("projection_m", self.projection_m);
    visit("flare_m", self.flare_m);
    visit("root_height_m", self.root_height_m);
    visit("tip_height_m", self.tip_height_m);
    visit("blade_depth_m", self.blade_depth_m);
    visit("boss_diameter_m", self.boss_diameter_m);
    visit("squareness", self.squareness);
    visit("rose", self.rose);
    visit("finish", self.finish);
  }
};

Part BuildLatchLever(const nlohmann::ordered_json& json, const std::string& path) {
  const auto lever = ReadParameters<LatchLever>(json, path);
  RequireRange(path, "length_m", lever.length_m, 0.08, 0.13);
  RequireRange(path, "projection_m", lever.projection_m, 0.03, 0.05);
  RequireRange(path, "flare_m", lever.flare_m, 0, 0.014);
  RequireRange(path, "root_height_m", lever.root_height_m, 0.008, 0.026);
  RequireRange(path, "tip_height_m", lever.tip_height_m, 0.01, 0.034);
  RequireRange(path, "blade_depth_m", lever.blade_depth_m, 0.006, 0.016);
  RequireRange(path, "boss_diameter_m", lever.boss_diameter_m, 0.02, 0.045);
  RequireRange(path, "squareness", lever.squareness, 2, 10);
  Part part;
  const double start = AddRose(lever.rose, path + ".rose", part);
  const double boss = lever.boss_diameter_m / 2;
  std::vector<Eigen::Vector3d> points;
  constexpr int kSteps = 10;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps;
    const double y = boss + 0.0002 + t * (lever.length_m - boss - 0.0002);
    points.emplace_back(lever.projection_m + lever.flare_m * t * t, -y, 0);
  }
  const auto section = [&](double fraction) {
    const double height =
        lever.root_height_m + (lever.tip_height_m - lever.root_height_m) * fraction;
    return Section{lever.blade_depth_m / 2, height / 2, lever.squareness};
  };
  const Eigen::Vector3d last = (points[kSteps] - points[kSteps - 1]).normalized();
  const auto rings = SweepRings(SmoothPath(points, -Eigen::Vector3d::UnitY(), last),
                                Eigen::Vector3d::UnitZ(), section, 0.003);
  const double end = lever.projection_m + 0.75 * lever.blade_depth_m;
  const Solid drum = LatheSolid({{start, 1.1 * boss},
                                 {start + 0.004, boss},
                                 {end - 0.004, boss},
                                 {end - 0.001, boss - 0.002},
                                 {end, boss - 0.005}},
                                {28, 0, 0});
  part.pieces.push_back(MakePiece("grip",
                                  Joined({LoftSolid(rings, kLatchLeverHullToleranceM), drum}),
                                  lever.finish, path + ".finish"));
  part.joint = HandleJoint(true);
  part.part_from_grasp = GraspAt(
      {lever.projection_m + 0.36 * lever.flare_m, -0.6 * lever.length_m, 0}, Closing::kVertical);
  part.grasp_half_extent_m = {0.15 * lever.length_m, 0.004, lever.blade_depth_m / 2 + 0.002};
  return part;
}

}  // namespace

std::span<const Family> LatchLeverFamilies() {
  static const Family kFamilies[] = {
      {"latch_lever", PartRole::kHandle, Mechanism::kLever, BuildLatchLever},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
