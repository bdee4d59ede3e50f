// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/bolt.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

constexpr double kHalfWidth = 0.006;         // [m] of the bolt, in x and z
constexpr double kInLeaf = 0.02;             // [m] behind the leaf's edge
constexpr double kTipWidth = 0.001;          // [m] what the bevel leaves of the tip
constexpr double kPlay = 0.001;              // [m] of a hung door in its latch
constexpr double kMostPlay = 0.004;          // [rad] the same at the hinge, for narrow leaves
constexpr double kClearance = 0.03;          // of the throw
constexpr double kStrikeThickness = 0.02;    // [m]
constexpr double kStrikeHalfHeight = 0.018;  // [m]
constexpr double kLipSlope = 0.4;            // steeper than the way of the bolt over it
constexpr double kSpareTravel = 0.002;       // [m]
constexpr double kOrdinaryThrow = 0.012;     // [m]

/// A point beside the hinge: along the opening way and out of the free edge.
using Flat = Eigen::Vector2d;

Flat Opened(const Flat& closed, double hinge_rad) {
  const double c = std::cos(hinge_rad);
  const double s = std::sin(hinge_rad);
  return {c * closed.x() + s * closed.y(), c * closed.y() - s * closed.x()};
}

Eigen::AlignedBox3d LeafBounds(const DoorAsset& door) {
  Eigen::AlignedBox3d bounds;
  for (const DoorGeometry& geometry : door.links[kLeafLink].geometry) {
    if (geometry.label == PointLabel::kHandle) continue;
    for (const Eigen::Vector3d& vertex : geometry.mesh.vertices) bounds.extend(vertex);
  }
  return bounds;
}

// On the leaf's free edge at the handle's height, x the opening way, y out of the edge.
RigidTransform EdgeFrame(const DoorAsset& door, const Eigen::AlignedBox3d& leaf) {
  const bool left = door.hinge_side == HingeSide::kLeft;
  const double opens = door.opening == Opening::kPull ? 1 : -1;
  RigidTransform frame =
      Translation({leaf.center().x(), left ? leaf.max().y() : leaf.min().y(),
                   door.handle_joint.parent_from_child_at_zero.translation().z()});
  frame.linear().col(0) = Eigen::Vector3d(opens, 0, 0);
  frame.linear().col(1) = Eigen::Vector3d(0, left ? 1 : -1, 0);
  frame.linear().col(2) = frame.linear().col(0).cross(frame.linear().col(1));
  return frame;
}

// Convex outline in x and y, counter-clockwise, and as far up as down.
TriangleMesh Prism(std::span<const Flat> outline, double half_height) {
  TriangleMesh mesh;
  const int n = static_cast<int>(outline.size());
  for (const Flat& corner : outline) {
    mesh.vertices.emplace_back(corner.x(), corner.y(), -half_height);
    mesh.vertices.emplace_back(corner.x(), corner.y(), half_height);
  }
  for (int i = 0; i < n; ++i) {
    const int a = 2 * i;
    const int b = 2 * ((i + 1) % n);
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, a + 1}, {b, b + 1, a + 1}});
    if (i > 0 && i + 1 < n)
      mesh.triangles.insert(mesh.triangles.end(), {{0, b, a}, {1, a + 1, b + 1}});
  }
  return mesh;
}

// The bevel is on the side that meets the strike as the door closes. It takes up the whole throw,
// so that the strike never meets the flat side behind it.
TriangleMesh BoltHull(double throw_m) {
  const double bevel = std::max(2 * kHalfWidth - kTipWidth, throw_m + 0.002);
  const std::array<Flat, 5> outline = {Flat{-kHalfWidth, -kInLeaf},
                                       {kHalfWidth, -kInLeaf},
                                       {kHalfWidth, throw_m},
                                       {kHalfWidth - kTipWidth, throw_m},
                                       {-kHalfWidth, throw_m - bevel}};
  return Prism(outline, kHalfWidth);
}

// The lip falls away from the leaf faster than a bolt at rest in the leaf moves out over it, which
// it does where the hinge lies on the opening side of a thick leaf.
TriangleMesh StrikeHull(double throw_m, double way_of_tip) {
  const double fall = (std::max(way_of_tip, 0.0) + kLipSlope) * kStrikeThickness;
  const double depth = throw_m + fall + 0.005;
  const std::array<Flat, 4> outline = {
      Flat{0, 0}, {kStrikeThickness, fall}, {kStrikeThickness, depth}, {0, depth}};
  return Prism(outline, kStrikeHalfHeight);
}

}  // namespace

Bolt BoltOf(const DoorAsset& door) {
  const auto require = [&](bool holds, const char* what) {
    Require(holds, ErrorCode::kInvalidArgument, "bolt of door \"" + door.id + "\": " + what);
  };
  const Eigen::AlignedBox3d leaf = LeafBounds(door);
  Bolt bolt;
  bolt.throw_m = door.latch.type == LatchType::kBolt ? door.latch.bolt_throw_m : kOrdinaryThrow;
  require(door.handle_joint.upper_rad > 0, "the handle does not turn");
  require(!leaf.isEmpty(), "the leaf has no mesh");
  require(bolt.throw_m > 0, "its throw must be positive");
  require(door.latch.unlock_angle_rad > 0, "the unlock angle must be positive");

  bolt.travel_m_per_rad = bolt.throw_m / door.latch.unlock_angle_rad;
  bolt.travel_m =
      std::max(bolt.throw_m, bolt.travel_m_per_rad * door.handle_joint.upper_rad) + kSpareTravel;
  bolt.leaf_from_bolt = EdgeFrame(door, leaf);
  bolt.bolt_hull = BoltHull(bolt.throw_m);
  bolt.tip_m = {kHalfWidth, bolt.throw_m, 0};

  // where the bolt, drawn back, meets the plane of the strike's face
  const Eigen::Vector3d tip_in_edge_frame = {kHalfWidth, 0, 0};
  const Eigen::Vector3d drawn =
      bolt.leaf_from_bolt.linear().transpose() * (bolt.leaf_from_bolt * tip_in_edge_frame);
  const double radius = drawn.y();
  bolt.play_m = std::min(kPlay, kMostPlay * std::abs(radius));
  bolt.clearance_m = kClearance * bolt.throw_m;
  const Flat closed = drawn.head<2>();
  const Flat met = Opened(closed, bolt.play_m / std::max(std::abs(radius), 0.01));
  const double rise = std::max(met.y() - closed.y(), 0.0);
  bolt.strike_thickness_m = kStrikeThickness;
  bolt.strike_hull = StrikeHull(bolt.throw_m, -closed.x() / std::max(std::abs(radius), 0.01));
  bolt.base_from_strike = door.hinge.parent_from_child_at_zero * bolt.leaf_from_bolt *
                          Translation({kHalfWidth + bolt.play_m, rise + bolt.clearance_m, 0});
  return bolt;
}

bool IsCaught(const Bolt& bolt, const DoorAsset& door, double hinge_rad, double position_m) {
  const RigidTransform base_from_leaf =
      door.hinge.parent_from_child_at_zero * RotationAbout(door.hinge.axis, hinge_rad);
  const Eigen::Vector3d tip =
      bolt.base_from_strike.inverse() *
      (base_from_leaf * (bolt.leaf_from_bolt * (bolt.tip_m + Eigen::Vector3d(0, position_m, 0))));
  return tip.y() > 0 && tip.x() < bolt.strike_thickness_m / 2;
}

}  // namespace doorforge
