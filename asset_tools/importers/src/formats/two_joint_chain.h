// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "doorforge/schemas/urdf.h"

namespace doorforge {

/// A link and its pose at zero joint angles.
struct PlacedLink {
  std::size_t index;  ///< Into UrdfModel::links.
  RigidTransform base_from_link;
};

/// A URDF seen as frame, leaf and handle: three bodies after fixed joints are merged.
struct TwoJointChain {
  std::vector<PlacedLink> frame;  ///< The root and what is fixed to it.
  std::vector<PlacedLink> leaf;   ///< The hinge's child.
  std::vector<PlacedLink> rose;   ///< What is fixed to the leaf.
  std::vector<PlacedLink> grip;   ///< The handle joint's child and what is fixed to it.
  std::size_t hinge = 0;          ///< Into UrdfModel::joints.
  std::size_t handle = 0;
  RigidTransform base_from_hinge;
  RigidTransform base_from_handle;
};

/// Throws Error(kFormat) unless the model is a tree with exactly two revolute joints, one below the
/// other, and otherwise fixed ones; `where` names the file.
TwoJointChain FindTwoJointChain(const UrdfModel& model, const std::string& where);

}  // namespace doorforge
