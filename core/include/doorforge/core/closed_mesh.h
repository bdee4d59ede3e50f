// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// What a mesh is made of, by index: two vertices are the same only if their index is. Weld first
/// where a format repeats positions (ImportMesh() does).
struct MeshTopology {
  int boundary_edges = 0;         ///< Edges of exactly one triangle.
  int non_manifold_edges = 0;     ///< Edges of three or more triangles.
  int inconsistent_edges = 0;     ///< Edges that their two triangles run through the same way.
  int non_manifold_vertices = 0;  ///< Vertices whose triangles form more than one fan.
  int degenerate_triangles = 0;   ///< A repeated index, or zero area in double precision. Those
                                  ///< with a repeated index count nowhere else.
  int components = 0;             ///< Sets of triangles connected through edges.
  double volume_m3 = 0;           ///< Signed; a volume only where the mesh is closed.
  double area_m2 = 0;
  Eigen::AlignedBox3d
      bounds;  ///< They hold the vertices that triangles use; empty without triangles.
};

/// Deterministic, O(T log T). Throws Error(kInvalidArgument) on an index out of range or a vertex
/// that is not finite, naming it.
MeshTopology MeasureTopology(const TriangleMesh& mesh);

/// A triangle mesh that encloses a volume: each edge belongs to exactly two triangles, which run
/// through it in opposite directions, and the signed volume is positive.
///
/// Several closed pieces are allowed, also where they overlap or lie inside each other (an inner
/// piece that is oriented inwards is a cavity). Touching vertices are allowed. What takes a
/// ClosedMesh does not check these properties again.
class ClosedMesh {
 public:
  /// Empty if the mesh is not closed in this sense. Throws as MeasureTopology() does.
  static std::optional<ClosedMesh> From(TriangleMesh mesh);

  const TriangleMesh& mesh() const { return mesh_; }

 private:
  explicit ClosedMesh(TriangleMesh mesh) : mesh_(std::move(mesh)) {}

  TriangleMesh mesh_;
};

}  // namespace doorforge
