// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "placed_mesh.h"

namespace doorforge::internal {

TriangleMesh Placed(TriangleMesh mesh, const RigidTransform& to_from_mesh) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = to_from_mesh * vertex;
  return mesh;
}

TriangleMesh RoundedToFloat(TriangleMesh mesh) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = vertex.cast<float>().cast<double>();
  return mesh;
}

TriangleMesh JoinedMeshes(std::span<const TriangleMesh> meshes) {
  TriangleMesh joined;
  for (const TriangleMesh& mesh : meshes) {
    const Eigen::Vector3i first =
        Eigen::Vector3i::Constant(static_cast<int>(joined.vertices.size()));
    joined.vertices.insert(joined.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const Eigen::Vector3i& triangle : mesh.triangles)
      joined.triangles.push_back(triangle + first);
  }
  return joined;
}

Eigen::AlignedBox3d BoundsOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices) bounds.extend(vertex);
  return bounds;
}

}  // namespace doorforge::internal
