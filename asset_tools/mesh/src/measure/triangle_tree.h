// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// Bounding-volume tree over the triangles of a mesh, for distances and rays. Holds a copy of the
/// corners. Deterministic; safe to query from several threads.
class TriangleTree {
 public:
  /// Indices must be in range, vertices finite.
  explicit TriangleTree(const TriangleMesh& mesh);

  /// Distance to the nearest point of any triangle, or `at_most` if that is smaller.
  double Distance(const Eigen::Vector3d& point, double at_most = 1e300) const;

  /// One triangle of the mesh and how far it is.
  struct Near {
    int triangle = -1;  ///< A number of the tree's; -1 where none is so near.
    double distance_m = 0;
  };
  /// The nearest triangle and Distance().
  Near NearestTriangle(const Eigen::Vector3d& point, double at_most = 1e300) const;
  /// Distance to the nearest point of this triangle.
  double DistanceTo(int triangle, const Eigen::Vector3d& point) const;

  /// Whether the ray meets a triangle, of either side, farther than `from_m` from its origin.
  bool Hits(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from_m) const;

  /// Distance along the ray of unit direction to the nearest triangle, of either side, farther than
  /// `from_m`; infinity where there is none.
  double FirstHit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                  double from_m) const;

  /// How often the mesh winds around the point (Jacobson et al. 2013), summed exactly over all
  /// triangles: about 1 inside a closed mesh, 0 outside.
  double WindingNumber(const Eigen::Vector3d& point) const;

  /// Whether the winding number is above one half. The mesh must be closed. A ray counts sheets;
  /// where it passes an edge within rounding, or the point lies on the surface, the exact sum
  /// decides: so the answer is always that of WindingNumber().
  bool IsInside(const Eigen::Vector3d& point) const;

  bool empty() const { return triangles_.empty(); }

 private:
  struct Triangle {
    Eigen::Vector3d a, b, c;
  };
  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0;  // leaf: first triangle; inner: first child, the second follows it
    int count = 0;  // leaf: triangles; inner: 0
  };

  void Build(int node, int first, int count);
  /// The sheets that a ray leaves through, less those that it comes in through; nothing where a
  /// rounding error could change that.
  std::optional<int> SheetsBeyond(const Eigen::Vector3d& point) const;
  /// FirstHit(), or any hit where that is enough.
  double Nearest(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from_m,
                 bool any) const;

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
  double touch_m_ = 0;  // what counts as on the surface
};

}  // namespace doorforge
