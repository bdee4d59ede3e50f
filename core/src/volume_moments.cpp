// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "volume_moments.h"

#include <Eigen/LU>

namespace doorforge::internal {
namespace {

// The tetrahedron (0, a, b, c), whose integrals are closed forms in its corners; signed.
void AddTetrahedron(const Eigen::Matrix3d& corners, VolumeMoments& moments) {
  const double volume = corners.determinant() / 6;
  const Eigen::Vector3d sum = corners.rowwise().sum();
  moments.volume += volume;
  moments.first += volume / 4 * sum;
  moments.second += volume / 20 * (corners * corners.transpose() + sum * sum.transpose());
}

}  // namespace

void AddMoments(const TriangleMesh& mesh, const Eigen::Vector3d& center,
                const Eigen::Vector3d& scale, VolumeMoments& moments) {
  for (const Eigen::Vector3i& t : mesh.triangles) {
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k)
      corners.col(k) = (mesh.vertices[static_cast<std::size_t>(t[k])] - center).cwiseProduct(scale);
    AddTetrahedron(corners, moments);
  }
}

}  // namespace doorforge::internal
