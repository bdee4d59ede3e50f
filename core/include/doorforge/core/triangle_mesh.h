// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

namespace doorforge {

/// Indexed triangles in one frame. Holds no invariant beyond "indices are in range".
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;  ///< Positions [m], length V.
  std::vector<Eigen::Vector3i>
      triangles;  ///< Vertex indices, counter-clockwise from outside, length T.
};

}  // namespace doorforge
