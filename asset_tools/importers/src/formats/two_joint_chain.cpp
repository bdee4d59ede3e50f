// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "formats/two_joint_chain.h"

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

// walks down from the root and sorts links by how many movable joints lie above them
class ChainWalk {
 public:
  ChainWalk(const UrdfModel& model, const std::string& where) : model_(model), where_(where) {}

  TwoJointChain Run() {
    Visit({LinkIndex(RootLinkOf(model_)), RigidTransform::Identity()}, 0, false);
    if (movable_ != 2)
      throw Error(ErrorCode::kFormat, where_ + ": found " + std::to_string(movable_) +
                                          " movable joints; a door has two, the hinge and the "
                                          "handle on its leaf");
    return chain_;
  }

 private:
  std::size_t LinkIndex(const std::string& name) const {
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      if (model_.links[i].name == name) return i;
    }
    throw Error(ErrorCode::kFormat, where_ + ": no link \"" + name + '"');
  }

  void Visit(const PlacedLink& link, int depth, bool fixed_below_movable) {
    std::vector<PlacedLink>& group = depth == 0            ? chain_.frame
                                     : depth == 2          ? chain_.grip
                                     : fixed_below_movable ? chain_.rose
                                                           : chain_.leaf;
    group.push_back(link);
    const std::string& name = model_.links[link.index].name;
    for (std::size_t j = 0; j < model_.joints.size(); ++j) {
      const UrdfJoint& joint = model_.joints[j];
      if (joint.parent != name) continue;
      const RigidTransform base_from_joint = link.base_from_link * joint.parent_from_joint;
      const PlacedLink child{LinkIndex(joint.child), base_from_joint};
      if (joint.type == UrdfJointType::kFixed) {
        Visit(child, depth, true);
      } else {
        TakeMovable(j, base_from_joint, depth);
        Visit(child, depth + 1, false);
      }
    }
  }

  void TakeMovable(std::size_t j, const RigidTransform& base_from_joint, int depth) {
    ++movable_;
    const UrdfJoint& joint = model_.joints[j];
    if (joint.type != UrdfJointType::kRevolute)
      throw Error(ErrorCode::kFormat, where_ + ": joint \"" + joint.name +
                                          "\" is movable but not revolute; only hinged doors with "
                                          "a turning handle are imported");
    if (depth > 1 || movable_ > 2 || (depth == 0 && movable_ == 2))
      throw Error(ErrorCode::kFormat, where_ + ": joint \"" + joint.name +
                                          "\" is a third movable one or a second leaf; a door has "
                                          "a hinge and a handle on its leaf");
    if (joint.axis.norm() < 1e-9)
      throw Error(ErrorCode::kFormat, where_ + ": joint \"" + joint.name + "\" has no axis");
    (depth == 0 ? chain_.hinge : chain_.handle) = j;
    (depth == 0 ? chain_.base_from_hinge : chain_.base_from_handle) = base_from_joint;
  }

  const UrdfModel& model_;
  std::string where_;
  TwoJointChain chain_;
  int movable_ = 0;
};

}  // namespace

TwoJointChain FindTwoJointChain(const UrdfModel& model, const std::string& where) {
  return ChainWalk(model, where).Run();
}

}  // namespace doorforge
