// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "doorforge/solids/sweep.h"

#include "handles/handle_base.h"

namespace doorforge::internal {
namespace {

constexpr double kPullHullToleranceM = 0.001;

/// A vertical pull: one bar that leaves the leaf below and comes back to it above the mount.
struct Pull {
  double span_m = 0.16;         ///< Between the two feet's centres, along z.
  double projection_m = 0.042;  ///< From the leaf to the bar's centre line.
  double width_m = 0.012;       ///< The bar has it along y; the fingers close across it.
  double depth_m = 0.012;       ///< The bar has it along x where it runs parallel to the leaf.
  double squareness = 2;        ///< Exponent of the section: 2 ellipse, 8 nearly a rectangle.
  double middle_scale = 1;      ///< Width in the middle relative to the feet.
  std::string finish = "brushed_steel";

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    visit("span_m", self.span_m);
    visit("projection_m", self.projection_m);
    visit("width_m", self.width_m);
    visit("depth_m", self.depth_m);
    visit("squareness", self.squareness);
    visit("middle_scale", self.middle_scale);
    visit("finish", self.finish);
  }
};

struct BarPull : Pull {
  double corner_radius_m = 0.012;

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    Pull::VisitFields(self, visit);
    visit("corner_radius_m", self.corner_radius_m);
  }
};

struct BridgePull : BarPull {
  double foot_slope_m = 0.03;  ///< How far the legs lean in from the feet to the bar, along z.

  template <class Self, class Visitor>
  static void VisitFields(Self& self, Visitor&& visit) {
    BarPull::VisitFields(self, visit);
    visit("foot_slope_m", self.foot_slope_m);
  }
};

void Check(const Pull& pull, const std::string& path) {
  RequireRange(path, "span_m", pull.span_m, 0.09, 0.32);
  RequireRange(path, "projection_m", pull.projection_m, 0.034, 0.065);
  RequireRange(path, "width_m", pull.width_m, 0.008, 0.028);
  RequireRange(path, "depth_m", pull.depth_m, 0.006, 0.02);
  RequireRange(path, "squareness", pull.squareness, 2, 10);
  RequireRange(path, "middle_scale", pull.middle_scale, 0.6, 2.2);
}

void CheckCorner(const BarPull& pull, const std::string& path) {
  RequireRange(path, "corner_radius_m", pull.corner_radius_m, pull.depth_m / 2 + 0.001, 0.03);
}

Part PullPart(const Pull& pull, const std::string& path, const std::vector<PathPoint>& line) {
  const auto section = [&](double fraction) {
    const double middle = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * fraction);
    const double scale = 1 + (pull.middle_scale - 1) * middle;
    return Section{pull.depth_m / 2, pull.width_m / 2 * scale, pull.squareness};
  };
  const auto rings = SweepRings(line, Eigen::Vector3d::UnitY(), section, 0);
  Part part;
  part.pieces.push_back(
      MakePiece("grip", LoftSolid(rings, kPullHullToleranceM), pull.finish, path + ".finish"));
  part.joint = HandleJoint(false);
  part.part_from_grasp = GraspAt({pull.projection_m, 0, 0}, Closing::kHorizontal);
  part.grasp_half_extent_m = {0.2 * pull.span_m, 0.004, pull.depth_m / 2 + 0.002};
  return part;
}

// A flat arch: cosine in height, so that it leaves the leaf steeply and is level in the middle.
Part BuildBow(const nlohmann::ordered_json& json, const std::string& path) {
  const auto pull = ReadParameters<Pull>(json, path);
  Check(pull, path);
  std::vector<Eigen::Vector3d> points;
  constexpr int kSteps = 24;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = std::numbers::pi * i / kSteps;
    points.emplace_back(pull.projection_m * std::pow(std::sin(angle), 0.8), 0,
                        -pull.span_m / 2 * std::cos(angle));
  }
  return PullPart(pull, path,
                  SmoothPath(points, Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitX()));
}

Part BuildBar(const nlohmann::ordered_json& json, const std::string& path) {
  const auto pull = ReadParameters<BarPull>(json, path);
  Check(pull, path);
  CheckCorner(pull, path);
  const double z = pull.span_m / 2;
  const double x = pull.projection_m;
  return PullPart(pull, path,
                  FilletedPath({{0, 0, -z}, {x, 0, -z}, {x, 0, 0}, {x, 0, z}, {0, 0, z}},
                               pull.corner_radius_m));
}

Part BuildBridge(const nlohmann::ordered_json& json, const std::string& path) {
  const auto pull = ReadParameters<BridgePull>(json, path);
  Check(pull, path);
  CheckCorner(pull, path);
  RequireRange(path, "foot_slope_m", pull.foot_slope_m, 0.005, 0.3 * pull.span_m);
  const double z = pull.span_m / 2;
  const double bar_z = z - pull.foot_slope_m;
  const double x = pull.projection_m;
  const double foot = 0.25 * x;
  return PullPart(
      pull, path,
      FilletedPath(
          {{0, 0, -z}, {foot, 0, -z}, {x, 0, -bar_z}, {x, 0, bar_z}, {foot, 0, z}, {0, 0, z}},
          pull.corner_radius_m));
}

}  // namespace

std::span<const Family> PullFamilies() {
  static const Family kFamilies[] = {
      {"pull_bow", PartRole::kHandle, Mechanism::kNone, BuildBow},
      {"pull_bar", PartRole::kHandle, Mechanism::kNone, BuildBar},
      {"pull_bridge", PartRole::kHandle, Mechanism::kNone, BuildBridge},
  };
  return kFamilies;
}

}  // namespace doorforge::internal
