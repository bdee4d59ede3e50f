// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "doorforge/compose/compose.h"

#include "seat.h"

namespace doorforge {

/// What PreparedPart holds.
struct PreparedPart::State {
  /// A piece as doors share it: meshes with the origin on the joint's axis where the piece turns
  /// with its link, so that they are the same in every door.
  struct Shape {
    TriangleMesh mesh;
    std::vector<TriangleMesh> hulls;
    RigidTransform shape_from_part = RigidTransform::Identity();
    std::string sha256;  ///< A mesh pool's record of it has this hash.
    std::vector<std::string> hull_sha256;
    std::string mesh_sha256;
    VisualMesh visual;  ///< What its author drew; may be empty.
    VisualTexts texts;  ///< Its files.
    std::optional<VisualFiles> visual_files;
  };

  Part part;                                  ///< The config has changed it already.
  PartIdentity identity;                      ///< It names the part as it was made.
  std::vector<Shape> shapes;                  ///< One a piece of `part`.
  std::optional<internal::LeafSurface> leaf;  ///< Bodies have it.
  std::optional<internal::BackOutline> back;  ///< Handles have it, in their own frame.
};

namespace internal {

/// All pieces as one mesh, turned.
TriangleMesh WholeMesh(const Part& part, const Eigen::Matrix3d& turn);

}  // namespace internal
}  // namespace doorforge
