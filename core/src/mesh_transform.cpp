// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/mesh_transform.h"

namespace doorforge {

TriangleMesh Transformed(TriangleMesh mesh, const RigidTransform& to_from_mesh) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = to_from_mesh * vertex;
  return mesh;
}

// The vectoriser of GCC 12 takes the two conversions of x and y for none, so that only z is
// rounded: with -O2 of all vertices, with -O3 of those that are left over of whole fours. What is
// recorded for tests rests on the first: mending it changes data.
TriangleMesh RoundedToFloat(TriangleMesh mesh) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = vertex.cast<float>().cast<double>();
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
