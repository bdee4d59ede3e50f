// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "check/object_tree.h"

namespace doorforge::foreign {
namespace {

constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

}  // namespace

ObjectTree::ObjectTree(const ArticulatedObject& object)
    : joint_above(object.links.size(), -1),
      body_of(object.links.size(), kNowhere),
      moves(object.links.size(), false),
      world_from_link(object.links.size(), RigidTransform::Identity()) {
  for (std::size_t i = 0; i < object.links.size(); ++i) link_of.emplace(object.links[i].name, i);
  for (std::size_t j = 0; j < object.joints.size(); ++j) {
    const auto child = link_of.find(object.joints[j].child);
    if (child != link_of.end() && joint_above[child->second] < 0)
      joint_above[child->second] = static_cast<int>(j);
  }
  for (std::size_t i = 0; i < object.links.size(); ++i) {
    // up to a link that is settled or a root, then down again
    std::vector<std::size_t> way;
    std::size_t at = i;
    while (body_of[at] == kNowhere && way.size() <= object.links.size()) {
      way.push_back(at);
      if (joint_above[at] < 0) break;
      const auto parent =
          link_of.find(object.joints[static_cast<std::size_t>(joint_above[at])].parent);
      if (parent == link_of.end()) break;
      at = parent->second;
    }
    for (std::size_t k = way.size(); k-- > 0;) {
      const std::size_t link = way[k];
      if (body_of[link] != kNowhere) continue;
      body_of[link] = link;
      if (joint_above[link] < 0) continue;
      const ForeignJoint& joint = object.joints[static_cast<std::size_t>(joint_above[link])];
      const auto parent = link_of.find(joint.parent);
      const bool fixed = joint.type == ForeignJointType::kFixed;
      moves[link] = !fixed;
      if (parent == link_of.end() || body_of[parent->second] == kNowhere) continue;
      world_from_link[link] = world_from_link[parent->second] * joint.parent_from_joint *
                              joint.child_from_joint.inverse();
      if (fixed) body_of[link] = body_of[parent->second];
      moves[link] = moves[link] || moves[parent->second];
    }
  }
}

}  // namespace doorforge::foreign
