// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "source_mesh.h"
#include "urdf_objects/hinged_object.h"
#include "urdf_objects/joint_tree.h"

namespace doorforge::internal {

/// A visual of a hinged object, loaded, with z up and in metres, at zero joint angles.
struct HingedShape {
  std::size_t link;  ///< Into UrdfModel::links.
  bool handle;       ///< Its own name says so.
  SourceMesh source;
  TriangleMesh mesh;
};

struct HingedShapes {
  std::vector<HingedShape> shapes;                                   ///< In the order of the model.
  Eigen::Affine3d authored_from_base = Eigen::Affine3d::Identity();  ///< Turn and scale.
  double scale = 1;
  std::vector<std::string> left_out;  ///< Meshes that are absent and may be.
};

/// What a link is called, in lower case.
std::string WordFor(const HingedObject& object, std::size_t link);

/// "handle", "knob", "lever", "grip", "pull" or "latch" in a name in lower case.
bool IsHandleWord(const std::string& word);

/// Loads the visuals of all links (collision shapes of links without any). Throws as
/// ReadHingedObject().
HingedShapes LoadShapes(const HingedObject& object, const std::vector<TreeLink>& tree);

}  // namespace doorforge::internal
