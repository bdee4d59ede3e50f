// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "doorforge/mesh/import_mesh.h"

namespace doorforge {

/// Triangles that split a simple polygon (ear clipping in the plane of its Newell normal); a fan
/// where the polygon crosses itself. Corner numbers into `corners`. Throws Error(kFormat) on a
/// polygon that would take more than some seconds.
std::vector<Eigen::Vector3i> Triangulated(std::span<const Eigen::Vector3d> corners);

/// Collects what a reader finds and turns it into an ImportedMesh: polygons become triangles,
/// duplicates go, positions are welded.
class PolygonSoup {
 public:
  explicit PolygonSoup(const MeshImportLimits& limits) : max_triangles_(limits.max_triangles) {}

  /// Further polygons belong to this piece; a piece without triangles is dropped in the end.
  void BeginPiece(std::string name, const Eigen::Vector4d& color_rgba, int material = -1);
  /// Fewer than three corners: nothing. `texcoords` is empty or as long as `corners`; what is not
  /// finite in it becomes zero. Throws Error(kFormat) if a corner is not finite or beyond
  /// kLargestRawCoordinate, or if the corners or the triangles are too many.
  void AddPolygon(std::span<const Eigen::Vector3d> corners,
                  std::span<const Eigen::Vector2d> texcoords = {});

  /// Throws Error(kFormat) if there is no triangle.
  ImportedMesh Finish() &&;

 private:
  using Texcoords = Eigen::Matrix<double, 2, 3>;

  struct Piece {
    std::string name;
    Eigen::Vector4d color_rgba;
    int material = -1;
    std::vector<Eigen::Matrix3d> triangles;  // a corner a column
    std::vector<Texcoords> texcoords;        // of the first triangles; of the others there are none
  };

  /// One side of a piece's triangles while it is collected.
  class Side;

  std::vector<Piece> pieces_;
  std::uint64_t triangle_count_ = 0;
  std::uint64_t max_triangles_;
};

}  // namespace doorforge
