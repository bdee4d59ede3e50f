// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "primitive_door.h"

#include <array>
#include <numbers>
#include <string>
#include <utility>

namespace doorforge {
namespace {

constexpr double kLeafThickness = 0.04;
constexpr double kRadPerDegree = std::numbers::pi / 180;

// Disc about x.
TriangleMesh DiscMesh(double low_x, double high_x, double radius) {
  constexpr int kSides = 48;
  TriangleMesh mesh;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    for (const double x : {low_x, high_x})
      mesh.vertices.emplace_back(x, radius * std::cos(angle), radius * std::sin(angle));
  }
  for (int i = 0; i < kSides; ++i) {
    const int a = 2 * i;
    const int b = 2 * ((i + 1) % kSides);
    mesh.triangles.insert(mesh.triangles.end(), {{a, b + 1, a + 1}, {a, b, b + 1}});
    if (i > 0 && i + 1 < kSides)
      mesh.triangles.insert(mesh.triangles.end(), {{0, b, a}, {1, a + 1, b + 1}});
  }
  return mesh;
}

MassProperties BoxMass(double mass, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const Eigen::Vector3d square = (high - low).cwiseAbs2();
  MassProperties result;
  result.mass_kg = mass;
  result.center_of_mass_m = (low + high) / 2;
  result.inertia_kg_m2 =
      (mass / 12 * (Eigen::Vector3d::Constant(square.sum()) - square)).asDiagonal();
  return result;
}

DoorGeometry Piece(const std::string& name, const TriangleMesh& mesh, PointLabel label) {
  DoorGeometry geometry;
  geometry.name = name;
  geometry.mesh = mesh;
  geometry.hulls = {mesh};
  geometry.label = label;
  return geometry;
}

// Grasp frame whose fingers close along `closing`, approaching into the door.
RigidTransform GraspFrame(const Eigen::Vector3d& origin, const Eigen::Vector3d& closing) {
  RigidTransform frame = Translation(origin);
  const Eigen::Vector3d approach = -Eigen::Vector3d::UnitX();
  frame.linear().col(0) = closing.cross(approach);
  frame.linear().col(1) = closing;
  frame.linear().col(2) = approach;
  return frame;
}

void AddHandle(const PrimitiveDoor& door, DoorAsset& asset) {
  DoorLink& link = asset.links[kHandleLink];
  const double out = door.stand_off_m;
  const double half = door.thickness_m / 2;
  link.geometry.push_back(
      Piece("neck", BoxMesh({0, -0.009, -0.009}, {out, 0.009, 0.009}), PointLabel::kHandle));
  Eigen::Vector3d low(out - half, -door.length_m + half, -half);
  Eigen::Vector3d high(out + half, half, half);
  asset.handle_from_grasp =
      GraspFrame({out, half - door.grasp_fraction * door.length_m, 0}, Eigen::Vector3d::UnitZ());
  asset.grasp_half_extent_m = {0.15 * door.length_m, half, half};
  if (door.mechanism == Mechanism::kNone) {
    low = {out - half, -half, -door.length_m / 2};
    high = {out + half, half, door.length_m / 2};
    asset.handle_from_grasp = GraspFrame({out, 0, 0}, Eigen::Vector3d::UnitY());
  }
  TriangleMesh grip = BoxMesh(low, high);
  if (door.mechanism == Mechanism::kRound) {
    grip = DiscMesh(out - 0.022, out + 0.022, door.radius_m);
    asset.handle_from_grasp = GraspFrame({out, 0, 0}, Eigen::Vector3d::UnitZ());
    low = {out - 0.022, -door.radius_m, -door.radius_m};
    high = -low;
    high.x() = out + 0.022;
  }
  link.geometry.push_back(Piece("grip", grip, PointLabel::kHandle));
  link.mass = BoxMass(0.4, low, high);
}

// As seen in a mirror across y.
Eigen::Vector3d Mirrored(const Eigen::Vector3d& v) { return {v.x(), -v.y(), v.z()}; }

void Mirror(TriangleMesh& mesh) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = Mirrored(vertex);
  for (Eigen::Vector3i& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
}

void Mirror(DoorJoint& joint) {
  joint.axis = -Mirrored(joint.axis);  // a turn to the right becomes one to the left
  joint.parent_from_child_at_zero.translation() =
      Mirrored(joint.parent_from_child_at_zero.translation());
}

void HingeRight(DoorAsset& asset) {
  for (DoorLink& link : asset.links) {
    link.mass.center_of_mass_m = Mirrored(link.mass.center_of_mass_m);
    for (DoorGeometry& geometry : link.geometry) {
      Mirror(geometry.mesh);
      geometry.hulls = {geometry.mesh};
    }
  }
  Mirror(asset.hinge);
  Mirror(asset.handle_joint);
  asset.handle_from_grasp = GraspFrame(Mirrored(asset.handle_from_grasp.translation()),
                                       Mirrored(asset.handle_from_grasp.linear().col(1)));
  asset.hinge_side = HingeSide::kRight;
}

DoorAsset OnItsSide(DoorAsset asset, const PrimitiveDoor& door) {
  if (door.hinge_side == HingeSide::kRight) HingeRight(asset);
  if (door.opening == Opening::kPush) asset.hinge.axis = -asset.hinge.axis;
  asset.opening = door.opening;
  return asset;
}

}  // namespace

TriangleMesh BoxMesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                               (i & 4) != 0 ? high.z() : low.z());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

PrimitiveDoor RandomPrimitive(Mechanism mechanism, std::uint64_t seed, std::uint64_t index) {
  Rng rng(seed,
          "primitive/" + std::to_string(static_cast<int>(mechanism)) + "/" + std::to_string(index));
  PrimitiveDoor door;
  door.mechanism = mechanism;
  door.width_m = rng.Uniform(0.5, 0.9);
  door.height_m = rng.Uniform(0.9, 2.0);
  door.leaf_mass_kg = rng.Uniform(5, 25);
  door.handle_height_m = rng.Uniform(0.45, 0.9);
  door.stand_off_m = rng.Uniform(0.045, 0.07);
  door.length_m = rng.Uniform(0.08, 0.18);
  door.thickness_m = rng.Uniform(0.01, 0.03);
  door.radius_m = rng.Uniform(0.02, 0.034);
  door.grasp_fraction = rng.Uniform(0.45, 0.85);
  return door;
}

DoorAsset MakePrimitiveDoor(const PrimitiveDoor& door) {
  DoorAsset asset;
  asset.id = "primitive-" + std::string(NameOf(door.mechanism));
  asset.mechanism = door.mechanism;
  asset.license = "CC0-1.0";
  const char* names[] = {"base", "leaf", "handle"};
  for (std::size_t i = 0; i < 3; ++i) asset.links.at(i).name = names[i];

  const Eigen::Vector3d low(-kLeafThickness / 2, 0, 0);
  const Eigen::Vector3d high(kLeafThickness / 2, door.width_m, door.height_m);
  asset.links[kLeafLink].geometry.push_back(Piece("leaf", BoxMesh(low, high), PointLabel::kBody));
  asset.links[kLeafLink].mass = BoxMass(door.leaf_mass_kg, low, high);
  asset.hinge = {"hinge", RigidTransform::Identity(), {0, 0, -1}, 0, 110 * kRadPerDegree, 200, 3,
                 0.5};
  asset.handle_joint = {
      "handle_joint",
      Translation({kLeafThickness / 2, door.width_m - 0.06, door.handle_height_m}),
      {1, 0, 0},
      0,
      45 * kRadPerDegree,
      10,
      10,
      0.05};
  AddHandle(door, asset);
  if (door.mechanism == Mechanism::kNone) {
    asset.handle_joint.upper_rad = 0;
    return OnItsSide(std::move(asset), door);
  }
  asset.latch.type = LatchType::kEffort;
  asset.latch.unlock_angle_rad = 0.65 * asset.handle_joint.upper_rad;
  asset.latch.handle_done_angle_rad = 0.75 * asset.handle_joint.upper_rad;
  return OnItsSide(std::move(asset), door);
}

double InertiaAboutHinge(const DoorAsset& door) {
  double inertia = 0;
  for (const int link : {kLeafLink, kHandleLink}) {
    const MassProperties& mass = door.links[static_cast<std::size_t>(link)].mass;
    const RigidTransform leaf_from_link = link == kLeafLink
                                              ? RigidTransform::Identity()
                                              : door.handle_joint.parent_from_child_at_zero;
    const Eigen::Vector3d center = leaf_from_link * mass.center_of_mass_m;
    inertia += door.hinge.axis.dot(mass.inertia_kg_m2 * door.hinge.axis) +
               mass.mass_kg * center.cross(door.hinge.axis).squaredNorm();
  }
  return inertia;
}

}  // namespace doorforge
