// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "handle_base.h"

#include <numbers>
#include <vector>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

constexpr double kGapToGripM = 0.0005;

PlateShape RoseShape(const RoseParameters& rose, const std::string& path) {
  const double half = rose.width_m / 2;
  const double edge = rose.thickness_m * 0.35;
  if (rose.shape == "round") return {{half, half}, half, rose.thickness_m, edge};
  if (rose.shape == "square") return {{half, half}, 0.005, rose.thickness_m, edge};
  if (rose.shape == "plate")
    return {{half, rose.height_m / 2}, half * 0.45, rose.thickness_m, edge};
  throw Error(ErrorCode::kInvalidConfig,
              path + ".shape: found \"" + rose.shape + "\", allowed round, square, plate, none");
}

Solid CylinderBoss(double plate_height_m, double plate_thickness_m) {
  const PlateShape boss{{0.0085, 0.016}, 0.0085, 0.005, 0.0015};
  return Moved(PlateSolid(boss, {0, -plate_height_m * 0.32}), {plate_thickness_m, 0, 0});
}

}  // namespace

double AddRose(const RoseParameters& rose, const std::string& path, Part& part) {
  if (rose.shape == "none") return 0;
  RequireRange(path, "width_m", rose.width_m, 0.02, 0.07);
  RequireRange(path, "height_m", rose.height_m, 0.06, 0.28);
  RequireRange(path, "thickness_m", rose.thickness_m, 0.004, 0.016);
  const double center_z = rose.shape == "plate" ? -rose.height_m * 0.14 : 0;
  Solid solid = PlateSolid(RoseShape(rose, path), {0, center_z});
  if (rose.keyhole && rose.shape == "plate")
    solid = Joined({solid, CylinderBoss(rose.height_m, rose.thickness_m)});
  part.pieces.push_back(MakePiece("rose", solid, rose.finish, path));
  return rose.thickness_m + kGapToGripM;
}

RigidTransform GraspAt(const Eigen::Vector3d& position_m, Closing closing) {
  RigidTransform pose = RigidTransform::Identity();
  const Eigen::Vector3d approach = -Eigen::Vector3d::UnitX();
  const Eigen::Vector3d close =
      closing == Closing::kVertical ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
  pose.linear() << close.cross(approach), close, approach;
  pose.translation() = position_m;
  return pose;
}

PartJoint HandleJoint(bool turns) {
  return {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), 0, turns ? std::numbers::pi / 4 : 0};
}

}  // namespace doorforge::internal
