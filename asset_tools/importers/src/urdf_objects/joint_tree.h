// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/schemas/urdf.h"

namespace doorforge::internal {

/// A link in its tree, at zero joint angles.
struct TreeLink {
  RigidTransform base_from_link = RigidTransform::Identity();
  std::optional<std::size_t> joint;   ///< Into UrdfModel::joints; nothing at the root.
  std::optional<std::size_t> parent;  ///< Into UrdfModel::links.
  std::vector<std::size_t> movable;   ///< Joints that carry it, the root's first.
};

bool IsMovable(const UrdfJoint& joint);
bool Turns(const UrdfJoint& joint);  ///< Revolute or continuous.

/// One entry a link, in the order of the model. Throws Error(kFormat) if the model is no tree;
/// `where` names the file.
std::vector<TreeLink> JointTreeOf(const UrdfModel& model, const std::string& where);

}  // namespace doorforge::internal
