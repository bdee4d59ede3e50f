// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "urdf_objects/leaf_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "doorforge/core/mesh_transform.h"

namespace doorforge::internal {
namespace {

constexpr double kAjar = 0.02;           // [rad] less is how people place a leaf by hand
constexpr double kSmallerOutline = 0.7;  // an outline that shrinks to less was that of an open leaf
constexpr double kUnlimited = std::numbers::pi / 2;
const double kUpright = std::cos(20 * std::numbers::pi / 180);
const double kLevel = std::sin(20 * std::numbers::pi / 180);

// area that a box takes across the hinge
double Across(const PartJoint& hinge, const Eigen::AlignedBox3d& box) {
  int along = 0;
  hinge.axis.cwiseAbs().maxCoeff(&along);
  return box.sizes()[(along + 1) % 3] * box.sizes()[(along + 2) % 3];
}

// what the leaf takes across its hinge, alone and with what is around it
struct Outline {
  double leaf;
  double whole;
};

Outline OutlineAt(const AuthoredLeaf& leaf, double angle) {
  const Eigen::Matrix3d turn = RotationAbout(leaf.hinge.axis, angle).linear();
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : leaf.mesh.vertices)
    box.extend(Eigen::Vector3d(turn * (vertex - leaf.hinge.origin_m) + leaf.hinge.origin_m));
  return {Across(leaf.hinge, box), Across(leaf.hinge, leaf.around.merged(box))};
}

// the angle at which the leaf is shut
double ClosedAngle(const AuthoredLeaf& leaf) {
  if (!leaf.limited) return 0;
  std::array<double, 2> limits = {leaf.hinge.lower_rad, leaf.hinge.upper_rad};
  if (std::abs(limits[1]) < std::abs(limits[0])) std::swap(limits[0], limits[1]);
  const Outline rest = OutlineAt(leaf, 0);
  for (const double limit : limits) {
    if (std::abs(limit) <= kAjar) continue;
    const Outline there = OutlineAt(leaf, limit);
    if (there.leaf < kSmallerOutline * rest.leaf || there.whole < kSmallerOutline * rest.whole)
      return limit;
  }
  return 0;
}

Eigen::Vector3d VelocityAt(const PartJoint& joint, const Eigen::Vector3d& point) {
  return joint.axis.cross(point - joint.origin_m);
}

// away from what does not move is out; positive where nothing tells
bool OpensBackwards(const PartJoint& hinge, const Eigen::Vector3d& center,
                    const Eigen::AlignedBox3d& around) {
  if (around.isEmpty()) return false;
  return VelocityAt(hinge, center).dot(center - around.center()) < -1e-9;
}

// from shut at 0 to the larger of both sides
PartJoint OpeningJoint(const AuthoredLeaf& leaf, double closed, const Eigen::Vector3d& center) {
  PartJoint hinge = leaf.hinge;
  const double lower = leaf.limited ? hinge.lower_rad - closed : -kUnlimited;
  const double upper = leaf.limited ? hinge.upper_rad - closed : kUnlimited;
  const bool both_ways = std::abs(upper + lower) < 0.1 * (upper - lower);
  const bool backwards = both_ways ? OpensBackwards(hinge, center, leaf.around) : -lower > upper;
  if (backwards) hinge.axis = -hinge.axis;
  hinge.lower_rad = 0;
  hinge.upper_rad = backwards ? -lower : upper;
  return hinge;
}

// [rad] of a direction in the plane, at the nearest quarter turn if one is near
double Heading(const Eigen::Vector3d& direction) {
  const double angle = std::atan2(direction.y(), direction.x());
  const double quarter = std::numbers::pi / 2;
  const double snapped = std::round(angle / quarter) * quarter;
  return std::abs(angle - snapped) < 20 * std::numbers::pi / 180 ? snapped : angle;
}

Eigen::Matrix3d ExactTurn(double angle) {
  Eigen::Matrix3d turn = RotationAbout(Eigen::Vector3d::UnitZ(), angle).linear();
  // a quarter turn moves numbers, it does not round them
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double whole = std::round(turn(i, j));
      if (std::abs(turn(i, j) - whole) < 1e-12) turn(i, j) = whole;
    }
  }
  return turn;
}

LeafMotion Refused(const std::string& why) {
  LeafMotion motion;
  motion.refusal = why;
  return motion;
}

}  // namespace

PartJoint MovedJoint(const PartJoint& joint, const Eigen::Affine3d& to_from_joint) {
  PartJoint moved = joint;
  moved.origin_m = to_from_joint * joint.origin_m;
  moved.axis = (to_from_joint.linear() * joint.axis).normalized();
  if (to_from_joint.linear().determinant() < 0) moved.axis = -moved.axis;
  return moved;
}

LeafMotion FindLeafMotion(const AuthoredLeaf& leaf) {
  LeafMotion motion;
  const double closed = ClosedAngle(leaf);
  motion.ajar_rad = std::abs(closed);
  motion.closing = Translation(leaf.hinge.origin_m) * RotationAbout(leaf.hinge.axis, closed) *
                   Translation(-leaf.hinge.origin_m);
  const Eigen::Vector3d center = BoundsOf(Transformed(leaf.mesh, motion.closing)).center();
  const PartJoint hinge = OpeningJoint(leaf, closed, center);
  if (!(hinge.upper_rad > kAjar)) return Refused("its limits leave it no room to open");

  const double up = std::abs(hinge.axis.z());
  motion.level = up < kLevel;
  if (!motion.level && up < kUpright) return Refused("its hinge is neither upright nor level");
  const Eigen::Vector3d velocity = VelocityAt(hinge, center);
  const Eigen::Vector3d out(velocity.x(), velocity.y(), 0);
  if (velocity.norm() < 1e-6)
    return Refused("it turns about its own middle, like a knob or a wheel");
  if (out.norm() < 0.5 * velocity.norm())
    return Refused("opening lifts it like a lid; a door swings out");

  motion.part_from_authored.linear() = ExactTurn(-Heading(out));
  const Eigen::Vector3d arm = motion.part_from_authored.linear() * (center - hinge.origin_m);
  motion.mirrored = !motion.level && arm.y() < 0;
  if (motion.mirrored)
    motion.part_from_authored = Eigen::Scaling(1.0, -1.0, 1.0) * motion.part_from_authored;
  motion.hinge = MovedJoint(hinge, motion.part_from_authored);
  return motion;
}

}  // namespace doorforge::internal
