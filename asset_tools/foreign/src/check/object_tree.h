// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "doorforge/foreign/articulated_object.h"

namespace doorforge::foreign {

/// How the links of an object hang together, by index. Of names that occur twice the first counts,
/// of joints to one child the first, and a joint that closes a loop or names no link is left out.
struct ObjectTree {
  explicit ObjectTree(const ArticulatedObject& object);

  std::map<std::string, std::size_t> link_of;  ///< The keys are names of links.
  /// For each link the joint that it is the child of, or -1.
  std::vector<int> joint_above;
  /// For each link the link that its rigid body is named by: the highest one that fixed joints lead
  /// to.
  std::vector<std::size_t> body_of;
  std::vector<bool> moves;  ///< For each link: a joint that is not fixed lies above it.
  std::vector<RigidTransform> world_from_link;  ///< With all joints at zero.
};

}  // namespace doorforge::foreign
