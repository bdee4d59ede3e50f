// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>

#include <Eigen/Geometry>

#include "doorforge/mesh/import_mesh.h"
#include "doorforge/schemas/visual_mesh.h"

namespace doorforge::internal {

/// Collects what the files of one piece draw, both sides of sheets included: a surface for each
/// material, equal ones of several files as one. Names are made unique words; materials without a
/// name are called "material".
class AuthoredMesh {
 public:
  /// A reflection turns the triangles round. `color_rgba` stands in place of the file's materials.
  void Add(const ImportedMesh& mesh, const Eigen::Affine3d& piece_from_mesh,
           const std::optional<Eigen::Vector4d>& color_rgba);

  /// Numbers as files hold them.
  VisualMesh Finish() &&;

 private:
  VisualSurface& SurfaceOf(VisualMaterial material);
  void AddPiece(const ImportedPiece& piece, const Eigen::Affine3d& piece_from_mesh,
                VisualSurface& surface);

  VisualMesh mesh_;
  std::set<std::string> names_;
  std::vector<std::string> wanted_names_;  // of each surface
};

}  // namespace doorforge::internal
