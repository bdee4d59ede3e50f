// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "urdf_objects/joint_tree.h"

#include <map>

#include "doorforge/core/error.h"

namespace doorforge::internal {
namespace {

// also refuses a model with loops, so that a walk ends
std::string RootOf(const UrdfModel& model, const std::string& where) {
  try {
    return RootLinkOf(model);
  } catch (const Error& error) {
    throw Error(error.code(), where + ": " + error.what());
  }
}

}  // namespace

bool IsMovable(const UrdfJoint& joint) { return joint.type != UrdfJointType::kFixed; }

bool Turns(const UrdfJoint& joint) {
  return joint.type == UrdfJointType::kRevolute || joint.type == UrdfJointType::kContinuous;
}

std::vector<TreeLink> JointTreeOf(const UrdfModel& model, const std::string& where) {
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < model.links.size(); ++i) index[model.links[i].name] = i;
  std::multimap<std::string, std::size_t> joints_of;
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    joints_of.emplace(model.joints[j].parent, j);
  std::vector<TreeLink> tree(model.links.size());
  std::vector<std::size_t> open = {index.at(RootOf(model, where))};
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    const auto [first, last] = joints_of.equal_range(model.links[at].name);
    for (auto entry = first; entry != last; ++entry) {
      const UrdfJoint& joint = model.joints[entry->second];
      const std::size_t child = index.at(joint.child);
      TreeLink& link = tree[child];
      link.base_from_link = tree[at].base_from_link * joint.parent_from_joint;
      link.joint = entry->second;
      link.parent = at;
      link.movable = tree[at].movable;
      if (IsMovable(joint)) {
        if (joint.axis.norm() < 1e-9)
          throw Error(ErrorCode::kFormat, where + ": joint \"" + joint.name + "\" has no axis");
        link.movable.push_back(entry->second);
      }
      open.push_back(child);
    }
  }
  return tree;
}

}  // namespace doorforge::internal
