// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Our reader of URDF beside urdfdom: what both read is equal. What only one reads is no finding:
// ours refuses numbers that are not finite and links that hang on nothing, urdfdom a joint without
// limits.

#include <algorithm>
#include <array>
#include <cmath>

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include "doorforge/core/error.h"
#include "doorforge/schemas/urdf.h"

#include "fuzz_target.h"

namespace doorforge::fuzz {
namespace {

bool Near(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::max({1.0, std::abs(a), std::abs(b)});
}

bool Near(const Eigen::Vector3d& a, const urdf::Vector3& b) {
  return Near(a.x(), b.x) && Near(a.y(), b.y) && Near(a.z(), b.z);
}

int TypeOf(UrdfJointType type) {
  switch (type) {
    case UrdfJointType::kRevolute:
      return urdf::Joint::REVOLUTE;
    case UrdfJointType::kContinuous:
      return urdf::Joint::CONTINUOUS;
    case UrdfJointType::kPrismatic:
      return urdf::Joint::PRISMATIC;
    case UrdfJointType::kFixed:
      break;
  }
  return urdf::Joint::FIXED;
}

void CompareJoint(const UrdfJoint& ours, const urdf::Joint& theirs) {
  Expect(ours.parent == theirs.parent_link_name && ours.child == theirs.child_link_name,
         "a joint joins the links that urdfdom reads");
  Expect(TypeOf(ours.type) == theirs.type, "a joint is of the type that urdfdom reads");
  Expect(
      Near(ours.parent_from_joint.translation(), theirs.parent_to_joint_origin_transform.position),
      "a joint is where urdfdom reads it");
  if (ours.type == UrdfJointType::kFixed) return;
  Expect(Near(ours.axis, theirs.axis), "an axis is the one that urdfdom reads");
  if (!theirs.limits || ours.type == UrdfJointType::kContinuous) return;
  Expect(Near(ours.lower, theirs.limits->lower) && Near(ours.upper, theirs.limits->upper),
         "limits are those that urdfdom reads");
}

// urdfdom's reader of XML takes as many bytes for a character as its first byte says, the beginning
// of an element among them where a text is no UTF-8.
bool IsAscii(std::string_view input) {
  return std::ranges::none_of(input, [](char byte) { return (byte & 0x80) != 0; });
}

void Compare(std::string_view input) {
  if (!IsAscii(input)) return;
  const std::string text(input);
  std::vector<UrdfFault> faults;
  const UrdfModel ours = ParseUrdf(text, "input", faults);
  if (!faults.empty()) return;
  const urdf::ModelInterfaceSharedPtr theirs = urdf::parseURDF(text);
  if (!theirs) return;
  Expect(ours.name == theirs->getName(), "the name is the one that urdfdom reads");
  Expect(ours.links.size() == theirs->links_.size(), "there are as many links as urdfdom reads");
  Expect(ours.joints.size() == theirs->joints_.size(), "there are as many joints as urdfdom reads");
  for (const UrdfLink& link : ours.links)
    Expect(theirs->getLink(link.name) != nullptr, "urdfdom has each link, too");
  for (const UrdfJoint& joint : ours.joints) {
    const auto other = theirs->joints_.find(joint.name);
    Expect(other != theirs->joints_.end(), "urdfdom has each joint, too");
    CompareJoint(joint, *other->second);
  }
}

void CompareQuietly(std::string_view input) {
  console_bridge::noOutputHandler();
  Compare(input);
}

constexpr std::array kTargets{Target{"urdf_beside_urdfdom", Shape::kBytes, CompareQuietly}};

}  // namespace

std::span<const Target> Targets() { return kTargets; }

}  // namespace doorforge::fuzz
