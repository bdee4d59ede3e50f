// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "doorforge/core/mass_properties.h"
#include "doorforge/parts/mechanism.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// Axis-aligned box as a closed mesh of 12 triangles.
inline TriangleMesh BoxOf(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                               (i & 4) != 0 ? high.z() : low.z());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline TriangleMesh SideBySide(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both = a;
  const int offset = static_cast<int>(a.vertices.size());
  both.vertices.insert(both.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Eigen::Vector3i& t : b.triangles) both.triangles.emplace_back(t.array() + offset);
  return both;
}

inline void AddGeometry(const DoorGeometry& geometry, double density_kg_m3, DoorLink& link) {
  link.geometry.push_back(geometry);
  const std::array<MassProperties, 2> masses = {
      link.mass, MassPropertiesOf(*ClosedMesh::From(geometry.mesh), density_kg_m3)};
  link.mass = Combined(masses);
}

/// A door of boxes that breaks no rule: leaf 0.8 x 1.8 m, a lever of a neck and a bar of
/// 0.13 x 0.02 x 0.012 m, the bar's centre 46 mm in front of the leaf.
inline DoorAsset BoxDoor() {
  DoorAsset door;
  door.id = "box_door";
  door.category = Category::kInterior;
  door.mechanism = Mechanism::kLever;
  door.body.id = "box_body";
  door.handle.id = "box_lever";
  door.body.sha256 = door.handle.sha256 = std::string(64, '0');
  door.license = "CC0-1.0";
  const TriangleMesh frame = BoxOf({-0.1, -0.1, 0}, {-0.05, 0.9, 1.9});
  const TriangleMesh leaf = BoxOf({-0.0475, 0, 0.01}, {-0.0075, 0.8, 1.81});
  const TriangleMesh neck = BoxOf({0, -0.008, -0.008}, {0.041, 0.008, 0.008});
  const TriangleMesh bar = BoxOf({0.04, -0.12, -0.01}, {0.052, 0.01, 0.01});
  door.links[kBaseLink].name = "base";
  door.links[kLeafLink].name = "leaf";
  door.links[kHandleLink].name = "handle";
  AddGeometry({"frame", frame, {frame}, {1, 1, 1, 1}, PointLabel::kFrame}, 400,
              door.links[kBaseLink]);
  AddGeometry({"leaf", leaf, {leaf}, {1, 1, 1, 1}, PointLabel::kBody}, 300, door.links[kLeafLink]);
  AddGeometry({"grip", SideBySide(neck, bar), {neck, bar}, {1, 1, 1, 1}, PointLabel::kHandle}, 7000,
              door.links[kHandleLink]);
  door.hinge = {"hinge", Translation({0.0075, 0, 0}), -Eigen::Vector3d::UnitZ(), 0, 1.5, 300, 6,
                0.5};
  door.handle_joint = {"handle_joint",
                       Translation({-0.0075, 0.72, 0.81}),
                       Eigen::Vector3d::UnitX(),
                       0,
                       0.7853981633974483,
                       30,
                       12,
                       0.05};
  door.latch = LatchOf(door.category, door.mechanism, door.handle_joint.upper_rad);
  door.handle_from_grasp.linear() << 0, 0, -1, -1, 0, 0, 0, 1, 0;
  door.handle_from_grasp.translation() << 0.046, -0.07, 0;
  door.grasp_half_extent_m << 0.02, 0.004, 0.006;
  return door;
}

}  // namespace doorforge
