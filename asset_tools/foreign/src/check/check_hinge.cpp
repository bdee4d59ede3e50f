// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "check/check_hinge.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "doorforge/foreign/foreign_rules.h"

namespace doorforge::foreign {
namespace {

using Box = Eigen::AlignedBox3d;

bool TurnsAbout(const ForeignJoint& joint) {
  return joint.type == ForeignJointType::kRevolute || joint.type == ForeignJointType::kContinuous;
}

bool IsNamedLikeHandle(std::string name) {
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const char* word : {"handle", "lever", "knob", "grip"}) {
    if (name.find(word) != std::string::npos) return true;
  }
  return false;
}

/// Hinge and handle by index, and what is measured of them.
class DoorOfLinks {
 public:
  DoorOfLinks(const HingeQuestion& question, FaultList& faults, std::vector<std::string>& notes)
      : q_(question), faults_(faults), notes_(notes) {}

  void Check() {
    if (!FindHinge()) return;
    FindHandle();
    CheckLimits();
    CheckLine();
    CheckStanding();
    notes_.push_back(
        "not asked: HND001, HND002, HND004 to HND008, HND010, HND011, SWP, OPN, which need "
        "surfaces, "
        "grasp frames, latches and springs; `doorforge import` makes a door of which they can be");
  }

 private:
  const ForeignJoint& Hinge() const { return q_.object.joints[static_cast<std::size_t>(hinge_)]; }

  bool FindHinge() {
    std::vector<int> vertical;
    for (std::size_t j = 0; j < q_.object.joints.size(); ++j) {
      const ForeignJoint& joint = q_.object.joints[j];
      if (!q_.hinge.empty() && joint.name == q_.hinge) hinge_ = static_cast<int>(j);
      if (q_.hinge.empty() && TurnsAbout(joint) && IsVertical(joint))
        vertical.push_back(static_cast<int>(j));
    }
    if (!q_.hinge.empty()) {
      if (hinge_ < 0)
        faults_.Add("TRE011", q_.object.place, "--hinge \"" + q_.hinge + "\": no such joint");
      return hinge_ >= 0 && HasLeaf();
    }
    if (vertical.size() != 1) {
      if (!vertical.empty())
        notes_.push_back(std::to_string(vertical.size()) +
                         " joints may be a hinge: name one with --hinge for MEC and HND");
      return false;
    }
    hinge_ = vertical.front();
    if (!HasLeaf()) return false;
    notes_.push_back("assumed: the hinge is joint \"" + Hinge().name +
                     "\", the only one that turns about a vertical axis");
    return true;
  }

  bool HasLeaf() {
    const auto leaf = q_.tree.link_of.find(Hinge().child);
    if (leaf == q_.tree.link_of.end()) return false;
    leaf_ = leaf->second;
    return true;
  }

  bool IsVertical(const ForeignJoint& joint) const {
    const auto parent = q_.tree.link_of.find(joint.parent);
    const RigidTransform base = parent == q_.tree.link_of.end()
                                    ? RigidTransform::Identity()
                                    : q_.tree.world_from_link[parent->second];
    const Eigen::Vector3d axis =
        (base * joint.parent_from_joint).linear() * joint.axis.value_or(Eigen::Vector3d::UnitX());
    const Eigen::Vector3d up = Eigen::Vector3d::Unit(q_.object.y_up ? 1 : 2);
    return axis.norm() > 1e-9 && std::abs(axis.normalized().dot(up)) > 0.9;
  }

  bool IsBelowLeaf(std::size_t link) const {
    for (std::size_t steps = 0; steps <= q_.object.links.size(); ++steps) {
      if (link == leaf_) return true;
      const int joint = q_.tree.joint_above[link];
      if (joint < 0) return false;
      const auto parent =
          q_.tree.link_of.find(q_.object.joints[static_cast<std::size_t>(joint)].parent);
      if (parent == q_.tree.link_of.end()) return false;
      link = parent->second;
    }
    return false;
  }

  void FindHandle() {
    std::vector<int> named;
    for (std::size_t i = 0; i < q_.object.links.size(); ++i) {
      const std::string& name = q_.object.links[i].name;
      const bool wanted = q_.handle.empty()
                              ? i != leaf_ && IsNamedLikeHandle(name) && IsBelowLeaf(i)
                              : name == q_.handle;
      if (wanted) named.push_back(static_cast<int>(i));
    }
    if (!q_.handle.empty() && named.empty())
      faults_.Add("TRE011", q_.object.place, "--handle \"" + q_.handle + "\": no such link");
    if (named.size() != 1) return;
    handle_ = named.front();
    if (q_.handle.empty())
      notes_.push_back("assumed: the handle is link \"" +
                       q_.object.links[static_cast<std::size_t>(handle_)].name + "\", by its name");
  }

  void CheckLimits() {
    const ForeignJoint& hinge = Hinge();
    if (!hinge.limit || !hinge.limit->lower || !hinge.limit->upper) return;
    const double lower = *hinge.limit->lower;
    const double upper = *hinge.limit->upper;
    if (lower > upper) return;  // JNT004
    if (lower > 0 || upper < 0)
      faults_.Add("MEC002", hinge.limit->place,
                  Digits(lower) + " to " + Digits(upper) + " rad, without 0");
    const double opens = std::max(std::abs(lower), std::abs(upper));
    if (opens < AnyRule("MEC003").limit)
      faults_.Add("MEC003", hinge.limit->place, Measured(opens, "rad"));
  }

  Box InLeaf(std::size_t link) const {
    Box box;
    const Box& own = q_.bounds[link].all;
    if (own.isEmpty()) return box;
    const RigidTransform leaf_from_link =
        q_.tree.world_from_link[leaf_].inverse() * q_.tree.world_from_link[link];
    for (int corner = 0; corner < 8; ++corner)
      box.extend(leaf_from_link * own.corner(static_cast<Box::CornerType>(corner)));
    return box;
  }

  // All that fixed joints hold to the leaf, without the handle.
  Box Leaf() const {
    Box leaf;
    for (std::size_t i = 0; i < q_.object.links.size(); ++i) {
      if (q_.tree.body_of[i] == q_.tree.body_of[leaf_] && static_cast<int>(i) != handle_)
        if (const Box box = InLeaf(i); !box.isEmpty()) leaf.extend(box);
    }
    return leaf;
  }

  void CheckLine() {
    const Box leaf = Leaf();
    if (leaf.isEmpty()) return;
    const RigidTransform& leaf_from_joint = Hinge().child_from_joint;
    const Eigen::Vector3d axis =
        leaf_from_joint.linear() * Hinge().axis.value_or(Eigen::Vector3d::UnitX());
    if (axis.norm() < 1e-9) return;
    // the nearest point of the line to the box, by thirds: the distance is convex along the line
    const Eigen::Vector3d origin = leaf_from_joint.translation();
    const auto away = [&](double t) {
      return leaf.exteriorDistance(origin + t * axis.normalized());
    };
    double low = -(leaf.diagonal().norm() + (leaf.center() - origin).norm());
    double high = -low;
    for (int i = 0; i < 100; ++i) {
      const double third = (high - low) / 3;
      if (away(low + third) < away(high - third))
        high -= third;
      else
        low += third;
    }
    const double distance = away((low + high) / 2);
    if (distance > AnyRule("MEC009").limit)
      faults_.Add("MEC009", Hinge().place, Measured(distance, "m"));
  }

  void CheckStanding() {
    if (handle_ < 0) return;
    const Box leaf = Leaf();
    const Box handle = InLeaf(static_cast<std::size_t>(handle_));
    if (leaf.isEmpty() || handle.isEmpty()) return;
    int thin = 0;
    leaf.sizes().minCoeff(&thin);
    const SourcePlace& place = q_.object.links[static_cast<std::size_t>(handle_)].place;
    const double front = handle.max()[thin] - leaf.max()[thin];
    const double back = leaf.min()[thin] - handle.min()[thin];
    const double stands = std::max(front, back);
    // how far it stands out at least; a bowed leaf reaches beyond its surface at the handle
    if (stands > AnyRule("HND009").limit) faults_.Add("HND009", place, Measured(stands, "m"));
    double beyond = 0;
    for (int k = 0; k < 3; ++k) {
      if (k == thin) continue;
      beyond = std::max({beyond, handle.max()[k] - leaf.max()[k], leaf.min()[k] - handle.min()[k]});
    }
    if (beyond > AnyRule("HND003").limit) faults_.Add("HND003", place, Measured(beyond, "m"));
  }

  const HingeQuestion& q_;
  FaultList& faults_;
  std::vector<std::string>& notes_;
  int hinge_ = -1;
  std::size_t leaf_ = 0;
  int handle_ = -1;
};

}  // namespace

void CheckHinge(const HingeQuestion& question, FaultList& faults, std::vector<std::string>& notes) {
  if (question.object.joints.empty()) return;
  DoorOfLinks(question, faults, notes).Check();
}

}  // namespace doorforge::foreign
