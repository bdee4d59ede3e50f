// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "doorforge/core/mass_properties.h"
#include "doorforge/schemas/part.h"

#include "small_object.h"

namespace doorforge {

/// Axis-aligned box, closed and oriented.
inline TriangleMesh BoxMesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return Prism(Rectangle(low.x(), high.x(), low.y(), high.y()), 0, 1, low.z(), high.z());
}

inline TriangleMesh Together(TriangleMesh a, const TriangleMesh& b) {
  const Eigen::Vector3i first = Eigen::Vector3i::Constant(static_cast<int>(a.vertices.size()));
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Eigen::Vector3i& triangle : b.triangles) a.triangles.push_back(triangle + first);
  return a;
}

/// A piece whose only hull is its mesh.
inline PartPiece MakeSolid(const std::string& name, const TriangleMesh& mesh, double mass_kg) {
  PartPiece piece;
  piece.name = name;
  piece.mesh = mesh;
  piece.hulls = {mesh};
  const ClosedMesh closed = ClosedMesh::From(mesh).value();
  const double volume = MeasureTopology(mesh).volume_m3;
  piece.mass = MassPropertiesOf(closed, mass_kg / volume);
  return piece;
}

inline void Shift(PartPiece& piece, const Eigen::Vector3d& offset) {
  for (Eigen::Vector3d& vertex : piece.mesh.vertices) vertex += offset;
  for (TriangleMesh& hull : piece.hulls) {
    for (Eigen::Vector3d& vertex : hull.vertices) vertex += offset;
  }
}

/// The body of the small object in the part frame: leaf 0.8 x 1.6 m, front at x = 0.02.
inline Part SmallBody() {
  Part body;
  body.id = "small_body";
  body.license = "CC0-1.0";
  body.pieces = {MakeSolid("frame", BoxMesh({-0.04, 0.41, 0}, {0.04, 0.45, 1.65}), 8),
                 MakeSolid("leaf", BoxMesh({-0.02, -0.4, 0}, {0.02, 0.4, 1.6}), 20)};
  body.joint = {{0, -0.4, 1.6}, {0, 0, -1}, 0, 1.5};
  body.part_from_mount = Translation({0.02, 0.32, 0.8});
  return body;
}

/// The lever of the small object in the part frame: back at x = 0, bar towards -y.
inline Part SmallLever() {
  Part handle;
  handle.id = "small_lever";
  handle.role = PartRole::kHandle;
  handle.mechanism = Mechanism::kLever;
  handle.license = "CC0-1.0";
  const Profile l{{{0, -0.0125},
                   {0.05, -0.0125},
                   {0.05, -0.15},
                   {0.06875, -0.15},
                   {0.06875, 0.0125},
                   {0, 0.0125}},
                  {{0, 1, 5}, {1, 4, 5}, {1, 2, 3}, {1, 3, 4}}};
  handle.pieces = {MakeSolid("grip", Prism(l, 0, 1, -0.01125, 0.01125), 0.2)};
  handle.joint = {{0, 0, 0}, {1, 0, 0}, 0, 0.7853981633974483};
  handle.part_from_grasp = Translation({0.059375, -0.075, 0});
  handle.part_from_grasp.linear() << 0, 0, -1, -1, 0, 0, 0, 1, 0;
  handle.grasp_half_extent_m = {0.03, 0.02, 0.01};
  return handle;
}

}  // namespace doorforge
