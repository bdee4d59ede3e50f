// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/parts/mapped_part.h"

#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "doorforge/core/mesh_transform.h"

namespace doorforge::internal {
namespace {

TriangleMesh MappedMesh(TriangleMesh mesh, const Eigen::Matrix3d& linear) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = linear * vertex;
  if (linear.determinant() < 0) {
    for (Eigen::Vector3i& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return RoundedToFloat(std::move(mesh));
}

VisualMesh MappedVisual(VisualMesh mesh, const Eigen::Matrix3d& linear) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = linear * vertex;
  if (linear.determinant() < 0) {
    for (VisualSurface& surface : mesh.surfaces) {
      for (Eigen::Vector3i& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
      for (Eigen::Vector3i& texcoords : surface.texcoords) std::swap(texcoords[1], texcoords[2]);
    }
  }
  return PlacedAsFiled(std::move(mesh), RigidTransform::Identity());
}

// Second moments transform as L S L^T, which inertias do not.
MassProperties MappedMass(const MassProperties& mass, const Eigen::Matrix3d& linear) {
  const double volume_ratio = std::abs(linear.determinant());
  const Eigen::Matrix3d& inertia = mass.inertia_kg_m2;
  const Eigen::Matrix3d second = inertia.trace() / 2 * Eigen::Matrix3d::Identity() - inertia;
  const Eigen::Matrix3d mapped = volume_ratio * linear * second * linear.transpose();
  MassProperties result;
  result.mass_kg = volume_ratio * mass.mass_kg;
  result.center_of_mass_m = linear * mass.center_of_mass_m;
  result.inertia_kg_m2 = mapped.trace() * Eigen::Matrix3d::Identity() - mapped;
  return result;
}

PartJoint MappedJoint(PartJoint joint, const Eigen::Matrix3d& linear) {
  joint.origin_m = linear * joint.origin_m;
  // seen in a mirror, a right-handed turn is a left-handed one
  const double sense = linear.determinant() < 0 ? -1 : 1;
  joint.axis = sense * (linear * joint.axis).normalized();
  return joint;
}

}  // namespace

bool PartMap::IsIdentity() const {
  return scale == Eigen::Vector3d::Ones() && turn == Eigen::Matrix3d::Identity();
}

Part MappedPart(Part part, const PartMap& map) {
  if (map.IsIdentity()) return part;
  const Eigen::Matrix3d linear = map.turn * map.scale.asDiagonal();
  for (PartPiece& piece : part.pieces) {
    piece.mesh = MappedMesh(std::move(piece.mesh), linear);
    for (TriangleMesh& hull : piece.hulls) hull = MappedMesh(std::move(hull), linear);
    piece.mass = MappedMass(piece.mass, linear);
    piece.visual = MappedVisual(std::move(piece.visual), linear);
  }
  part.joint = MappedJoint(part.joint, linear);
  part.part_from_mount.translation() = linear * part.part_from_mount.translation();
  part.part_from_mount.linear() = map.turn * part.part_from_mount.linear() * map.turn.transpose();
  part.part_from_grasp.translation() = linear * part.part_from_grasp.translation();
  Eigen::Matrix3d grasp = map.turn * part.part_from_grasp.linear();
  if (map.turn.determinant() < 0) grasp.col(0) = -grasp.col(0);
  part.part_from_grasp.linear() = grasp;
  part.grasp_half_extent_m *= map.scale.x();
  return part;
}

Eigen::Matrix3d MirrorX() { return Eigen::Vector3d(-1, 1, 1).asDiagonal(); }

Eigen::Matrix3d MirrorY() { return Eigen::Vector3d(1, -1, 1).asDiagonal(); }

Eigen::Matrix3d QuarterTurnsAboutX(int quarters) {
  Eigen::Matrix3d once;
  once << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  for (int i = 0; i < quarters; ++i) turn = once * turn;
  return turn;
}

}  // namespace doorforge::internal
