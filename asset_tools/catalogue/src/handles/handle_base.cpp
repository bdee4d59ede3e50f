// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "handles/handle_base.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace doorforge::internal {
namespace {

constexpr double kGapToGripM = 0.0005;
constexpr double kRoseHullToleranceM = 0.001;

/// A plane outline that can be inset.
struct Outline {
  Eigen::Vector2d half_size_m;
  double radius_m = 0;    ///< The corners have it.
  bool cut = false;       ///< Corners are cut instead of rounded.
  bool elliptic = false;  ///< An ellipse; the radius does not count.
};

bool IsLong(RoseShape shape) {
  return shape == RoseShape::kPlate || shape == RoseShape::kStadium ||
         shape == RoseShape::kTablet || shape == RoseShape::kLens;
}

Outline OutlineOf(const RoseParameters& rose) {
  const double half = rose.width_m / 2;
  const Eigen::Vector2d square(half, half);
  const Eigen::Vector2d upright(half, rose.height_m / 2);
  switch (rose.shape) {
    case RoseShape::kNone:  // AddRose() makes nothing of it
    case RoseShape::kRound:
      return {square, half};
    case RoseShape::kSquare:
      return {square, 0.005};
    case RoseShape::kOctagon:
      return {square, 0.5858 * half, true};
    case RoseShape::kOval:
      return {{half, 0.68 * half}, 0, false, true};
    case RoseShape::kPlate:
      return {upright, half * 0.45};
    case RoseShape::kStadium:
      return {upright, half};
    case RoseShape::kTablet:
      return {upright, half * 0.6, true};
    case RoseShape::kLens:
      return {upright, 0, false, true};
  }
  throw std::logic_error("a rose of no shape");
}

// Points of an inset outline at height x above the leaf, around (y, z) = center.
Ring OutlineRing(const Outline& outline, double inset_m, double x, const Eigen::Vector2d& center) {
  constexpr int kSegments = 4;
  const Eigen::Vector2d half = outline.half_size_m.array() - inset_m;
  std::vector<Eigen::Vector2d> points;
  if (outline.elliptic) {
    for (int k = 0; k < 6 * kSegments; ++k) {
      const double angle = std::numbers::pi * (k + 0.5) / (3 * kSegments);
      points.emplace_back(half.x() * std::cos(angle), half.y() * std::sin(angle));
    }
  } else {
    // a cut corner keeps its angle when inset
    const double radius = std::max(0.0008, outline.radius_m - inset_m * (outline.cut ? 0.5858 : 1));
    points = RoundedRectangle(half, radius, outline.cut ? 1 : kSegments);
  }
  Ring ring;
  for (const Eigen::Vector2d& p : points)
    ring.emplace_back(x, center.x() + p.x(), center.y() + p.y());
  return ring;
}

// How the face comes in from the outline, as (inset, height).
std::vector<Eigen::Vector2d> FaceProfile(const RoseParameters& rose, double narrowest_m) {
  const double top = rose.thickness_m;
  std::vector<Eigen::Vector2d> profile = {{0, 0}};
  const double edge = 0.35 * top;
  if (rose.face == RoseFace::kStepped) {
    const double low = 0.5 * top;
    profile.insert(profile.end(), {{0, low - 0.001},
                                   {0.001, low},
                                   {0.25 * narrowest_m, low + 0.0005},
                                   {0.25 * narrowest_m + 0.0005, top - 0.001},
                                   {0.25 * narrowest_m + 0.0015, top}});
    return profile;
  }
  const double inset = rose.face == RoseFace::kFlat ? edge : 0.55 * narrowest_m;
  const double rise = rose.face == RoseFace::kFlat ? edge : 0.75 * top;
  for (const double degrees : {0.0, 30.0, 60.0, 90.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    profile.emplace_back(inset * (1 - std::cos(angle)), top - rise + rise * std::sin(angle));
  }
  return profile;
}

Solid Escutcheon(const Outline& outline, const std::vector<Eigen::Vector2d>& face,
                 const Eigen::Vector2d& center) {
  std::vector<Ring> rings;
  for (const Eigen::Vector2d& p : face) rings.push_back(OutlineRing(outline, p.x(), p.y(), center));
  return LoftSolid(rings, kRoseHullToleranceM);
}

Solid CylinderBoss(double z, double x) {
  const PlateShape boss{{0.0085, 0.016}, 0.0085, 0.005, 0.0015};
  return Moved(PlateSolid(boss, {0, z}), {x, 0, 0});
}

// A round foot with an upright wing to turn.
Solid ThumbTurn(double z, double x) {
  const PlateShape foot{{0.0095, 0.0095}, 0.0095, 0.004, 0.001};
  const Solid wing =
      ChamferedBox({x + 0.004, -0.0035, z - 0.014}, {x + 0.021, 0.0035, z + 0.014}, 0.0015);
  return Joined({Moved(PlateSolid(foot, {0, z}), {x, 0, 0}), wing});
}

// The lock below the handle, with an escutcheon of the rose's shape where no plate carries it.
Solid LockBelow(const RoseParameters& rose, const std::string& path) {
  const double z = -rose.lock_drop_m;
  std::vector<Solid> solids;
  if (!IsLong(rose.shape)) {
    // fingers on the handle need room to a lock above it
    const double nearest = std::max(rose.width_m + 0.006, z > 0 ? 0.076 : 0);
    RequireRange(path, "lock_drop_m (distance)", std::abs(z), nearest, 0.14);
    RoseParameters own = rose;
    own.width_m = std::max(0.038, 0.85 * rose.width_m);
    const Outline outline = OutlineOf(own);
    solids.push_back(Escutcheon(outline, FaceProfile(own, outline.half_size_m.minCoeff()), {0, z}));
  } else {
    const double low = (rose.center - 0.5) * rose.height_m;
    RequireRange(path, "lock_drop_m", rose.lock_drop_m, 0.045, -low - 0.02);
  }
  solids.push_back(rose.lock == RoseLock::kCylinder ? CylinderBoss(z, rose.thickness_m)
                                                    : ThumbTurn(z, rose.thickness_m));
  return Joined(solids);
}

}  // namespace

double AddRose(const RoseParameters& rose, const std::string& path, Part& part) {
  if (rose.shape == RoseShape::kNone) return 0;
  RequireRange(path, "width_m", rose.width_m, 0.02, 0.07);
  RequireRange(path, "height_m", rose.height_m, 0.06, 0.28);
  RequireRange(path, "thickness_m", rose.thickness_m, 0.004, 0.016);
  RequireRange(path, "center", rose.center, -0.36, 0.36);
  const double center_z = IsLong(rose.shape) ? rose.height_m * rose.center : 0;
  const Outline outline = OutlineOf(rose);
  std::vector<Solid> solids = {
      Escutcheon(outline, FaceProfile(rose, outline.half_size_m.minCoeff()), {0, center_z})};
  if (rose.keyhole && rose.shape == RoseShape::kPlate)
    solids.push_back(CylinderBoss(-rose.height_m * 0.32, rose.thickness_m));
  if (rose.lock != RoseLock::kNone) solids.push_back(LockBelow(rose, path));
  part.pieces.push_back(MakePiece("rose", Joined(solids), rose.finish, path));
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
