// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge::internal {

/// Volume integrals of 1, x and x x^T; signed.
struct VolumeMoments {
  double volume = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};

/// Adds those of a closed mesh in the coordinates (x - center) * scale, component by component. A
/// center within the mesh keeps the digits of one that lies far from the origin.
void AddMoments(const TriangleMesh& mesh, const Eigen::Vector3d& center,
                const Eigen::Vector3d& scale, VolumeMoments& moments);

}  // namespace doorforge::internal
