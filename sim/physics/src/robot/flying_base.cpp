// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/flying_base.h"

#include <algorithm>
#include <set>
#include <utility>

namespace doorforge::internal {
namespace {

// A joint of the way from the root to the hand.
struct FlyingJoint {
  const char* name;
  UrdfJointType type;
  Eigen::Vector3d axis;
  double range;     // [m or rad] to both sides
  double effort;    // [N or N m]
  double velocity;  // [m/s or rad/s]
};

// At all zeros the hand is before the chest of who would hold it. As strong as the built-in arm's
// wrist at arm's length: 87 N m over 0.6 m. Pitch ends before the poles, where yaw and roll are
// one.
constexpr double kHeight = 1.0;  // [m] over the root
const FlyingJoint kFlyingJoints[] = {
    {"fly_x", UrdfJointType::kPrismatic, Eigen::Vector3d::UnitX(), 1.5, 150, 1},
    {"fly_y", UrdfJointType::kPrismatic, Eigen::Vector3d::UnitY(), 1.5, 150, 1},
    {"fly_z", UrdfJointType::kPrismatic, Eigen::Vector3d::UnitZ(), 1.1, 150, 1},
    {"fly_yaw", UrdfJointType::kRevolute, Eigen::Vector3d::UnitZ(), 3.1, 30, 2.5},
    {"fly_pitch", UrdfJointType::kRevolute, Eigen::Vector3d::UnitY(), 1.5, 30, 2.5},
    {"fly_roll", UrdfJointType::kRevolute, Eigen::Vector3d::UnitX(), 6.2, 30, 2.5}};
constexpr std::size_t kFirstTurn = 3;

UrdfLink CarriageLink(const std::string& name) {
  UrdfLink link;
  link.name = name;
  MassProperties mass;
  mass.mass_kg = 0.5;
  mass.inertia_kg_m2 = Eigen::Vector3d::Constant(0.01).asDiagonal();
  link.inertial = mass;
  return link;
}

std::set<std::string> LinksFrom(const UrdfModel& urdf, const std::string& root) {
  std::set<std::string> links{root};
  // joints need not be in order: as many rounds as the tree is deep
  for (std::size_t before = 0; before != links.size();) {
    before = links.size();
    for (const UrdfJoint& joint : urdf.joints) {
      if (links.contains(joint.parent)) links.insert(joint.child);
    }
  }
  return links;
}

}  // namespace

UrdfModel HandAlone(const UrdfModel& urdf, const RobotRoles& roles, const RobotOptions& options,
                    RobotFaults& faults) {
  const std::set<std::string> links = LinksFrom(urdf, roles.hand_link);
  UrdfModel hand = urdf;
  std::erase_if(hand.links, [&](const UrdfLink& link) { return !links.contains(link.name); });
  std::erase_if(hand.joints, [&](const UrdfJoint& joint) { return !links.contains(joint.parent); });
  for (const UrdfJoint& joint : hand.joints) {
    const bool finger = std::ranges::find(roles.fingers, joint.name) != roles.fingers.end();
    if (joint.type != UrdfJointType::kFixed && !finger)
      faults.Add("joint \"" + joint.name + "\" moves on the hand and is no finger; make it fixed");
  }
  for (const std::string& finger : roles.fingers) {
    const bool kept = std::ranges::any_of(
        hand.joints, [&](const UrdfJoint& joint) { return joint.name == finger; });
    if (!kept)
      faults.Add("finger \"" + finger + "\" is not below the link \"" + roles.hand_link +
                 "\", which is all that flies; name another hand_link");
  }
  if (!options.tcp_link.empty() && !links.contains(options.tcp_link))
    faults.Add("tcp_link: \"" + options.tcp_link + "\" is not below the link \"" + roles.hand_link +
               "\", which is all that flies");
  faults.Check();  // what follows needs the whole hand
  return hand;
}

UrdfModel OnFlyingBase(UrdfModel hand, RobotRoles& roles) {
  const std::string root = RootLinkOf(hand);
  std::string parent = "doorforge_ground";
  hand.links.push_back({parent, {}, {}, {}});
  for (const FlyingJoint& row : kFlyingJoints) {
    const bool last = &row == &kFlyingJoints[kFloatingJointCount - 1];
    UrdfJoint joint;
    joint.name = std::string("doorforge_") + row.name;
    joint.type = row.type;
    joint.parent = parent;
    joint.child = last ? root : joint.name + "_carriage";
    joint.axis = row.axis;
    joint.lower = -row.range;
    joint.upper = row.range;
    joint.effort = row.effort;
    joint.velocity = row.velocity;
    if (&row == &kFlyingJoints[0]) joint.parent_from_joint = Translation({0, 0, kHeight});
    if (!last) hand.links.push_back(CarriageLink(joint.child));
    parent = joint.child;
    roles.base.push_back(joint.name);
    hand.joints.push_back(std::move(joint));
  }
  return hand;
}

void PointAhead(RobotDescription& robot) {
  Eigen::Matrix3d root_from_level_tool;
  root_from_level_tool << 0, 0, 1, 0, 1, 0, -1, 0, 0;  // z ahead, y to the left
  const Eigen::Matrix3d mount =
      root_from_level_tool * robot.tcp.body_from_frame.linear().transpose();
  robot.joints[kFirstTurn].parent_from_joint.linear() = mount;
  for (std::size_t i = kFirstTurn; i < kFloatingJointCount; ++i)
    robot.joints[i].axis = mount.transpose() * robot.joints[i].axis;
}

}  // namespace doorforge::internal
