// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "doorforge/importers/foreign_object.h"

#include "source_mesh.h"

namespace doorforge::internal {

/// A handle on its own, in a frame with the axes of a part.
struct HandleSource {
  std::string name;    ///< It names the object.
  std::string id;      ///< It names the part.
  std::string source;  ///< Its files are added.
  std::string license;
  Category category = Category::kInterior;
  Mechanism mechanism = Mechanism::kNone;
  /// A point on the axis, which runs along x (a flap's along z). Empty: the middle of the rose,
  /// else of the grip; a lever's at the end of the grip that is deepest, where its neck is.
  std::optional<Eigen::Vector3d> axis_point_m;
  /// The plane that lies on the leaf; empty: the rearmost.
  std::optional<double> leaf_plane_m;
  std::vector<SourceMesh> meshes;  ///< Pieces "grip" and maybe "rose".
  Eigen::AlignedBox3d stated_box;  ///< It holds the grip; it may be empty.
  /// A grasp point that the source states, in the same frame.
  std::optional<Eigen::Vector3d> grasp_m = {};
};

/// An object of one part. Loads the meshes once to find mount and grasp; throws as ImportMesh().
ForeignObject ReadHandle(const HandleSource& source);

}  // namespace doorforge::internal
