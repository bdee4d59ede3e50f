// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/mesh_transform.h"

namespace doorforge {

TriangleMesh Transformed(TriangleMesh mesh, const RigidTransform& to_from_mesh) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = to_from_mesh * vertex;
  return mesh;
}

// The vectoriser of GCC 12 takes pairs of conversions to float and back for none: with -O2 those of
// Eigen's casts, with -O3 those of plain loops too, where numbers are left over of whole fours. A
// call that is not inlined it cannot see through, and it costs a nanosecond.
[[gnu::noinline]] double RoundedToFloat(double number) {
  return static_cast<double>(static_cast<float>(number));
}

Eigen::Vector3d RoundedToFloat(const Eigen::Vector3d& point) {
  return {RoundedToFloat(point.x()), RoundedToFloat(point.y()), RoundedToFloat(point.z())};
}

TriangleMesh RoundedToFloat(TriangleMesh mesh) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = RoundedToFloat(vertex);
  return mesh;
}

TriangleMesh Merged(std::span<const TriangleMesh> meshes) {
  TriangleMesh merged;
  for (const TriangleMesh& mesh : meshes) {
    const Eigen::Vector3i first =
        Eigen::Vector3i::Constant(static_cast<int>(merged.vertices.size()));
    merged.vertices.insert(merged.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const Eigen::Vector3i& triangle : mesh.triangles)
      merged.triangles.push_back(triangle + first);
  }
  return merged;
}

Eigen::AlignedBox3d BoundsOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices) bounds.extend(vertex);
  return bounds;
}

}  // namespace doorforge
