// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "box_arm.h"

namespace doorforge {
namespace {

struct Segment {
  const char* name;
  Eigen::Vector3d from_parent;  ///< Of its joint.
  Eigen::Vector3d axis;
  Eigen::Vector3d size;
  Eigen::Vector3d center;
};

MassProperties CentredBoxMass(double mass, const Eigen::Vector3d& size,
                              const Eigen::Vector3d& center) {
  const Eigen::Vector3d square = size.cwiseAbs2();
  MassProperties properties;
  properties.mass_kg = mass;
  properties.center_of_mass_m = center;
  properties.inertia_kg_m2 =
      mass / 12 *
      Eigen::Vector3d(square.y() + square.z(), square.x() + square.z(), square.x() + square.y())
          .asDiagonal()
          .toDenseMatrix();
  return properties;
}

UrdfLink BoxLink(const std::string& name, double mass, const Eigen::Vector3d& size,
                 const Eigen::Vector3d& center) {
  UrdfLink link;
  link.name = name;
  link.inertial = CentredBoxMass(mass, size, center);
  UrdfShape shape;
  shape.name = name;
  shape.link_from_shape = Translation(center);
  shape.geometry = UrdfBox{size};
  link.visuals.push_back(shape);
  link.collisions.push_back(shape);
  return link;
}

UrdfJoint Joint(const std::string& name, UrdfJointType type, const std::string& parent,
                const std::string& child) {
  UrdfJoint joint;
  joint.name = name;
  joint.type = type;
  joint.parent = parent;
  joint.child = child;
  return joint;
}

void AddFinger(const std::string& name, double way, double lower, UrdfModel& arm) {
  // pads meet at z = 0 of the flange where the joint is at its upper limit
  arm.links.push_back(BoxLink(name, 0.1, {0.07, 0.02, 0.012}, {0.06, 0, way * 0.006}));
  UrdfJoint joint = Joint(name + "_slide", UrdfJointType::kPrismatic, "flange", name);
  joint.parent_from_joint = Translation({0.03, 0, way * 0.01});
  joint.axis = {0, 0, -2 * way};  // not of unit length
  joint.lower = lower;
  joint.upper = lower + 0.04;
  arm.joints.push_back(joint);
  // the joint's zero lies lower + 0.04 before the closed pads
  arm.links.back().visuals[0].link_from_shape.translation().z() += way * (lower + 0.03);
  arm.links.back().collisions[0].link_from_shape.translation().z() += way * (lower + 0.03);
}

}  // namespace

UrdfModel BoxArm() {
  UrdfModel arm;
  arm.name = "box_arm";
  arm.links.push_back(BoxLink("pedestal", 5, {0.16, 0.16, 0.1}, {0, 0, 0.05}));
  const Segment segments[] = {
      {"shoulder", {0, 0, 0.12}, {0, 0, 1}, {0.12, 0.12, 0.2}, {0, 0, 0.1}},
      {"upper", {0, 0.1, 0.22}, {0, 1, 0}, {0.09, 0.07, 0.42}, {0, 0, 0.2}},
      {"fore", {0, -0.08, 0.42}, {0, 1, 0}, {0.08, 0.07, 0.38}, {0, 0, 0.2}},
      {"wrist1", {0, 0.08, 0.4}, {0, 1, 0}, {0.07, 0.07, 0.1}, {0, 0, 0}},
      {"wrist2", {0, 0.09, 0}, {0, 0, 1}, {0.07, 0.07, 0.09}, {0, 0, 0}},
      {"flange", {0.08, 0, 0}, {1, 0, 0}, {0.06, 0.07, 0.1}, {0.03, 0, 0}}};
  std::string parent = "pedestal";
  for (const Segment& segment : segments) {
    arm.links.push_back(BoxLink(segment.name, 2, segment.size, segment.center));
    UrdfJoint joint =
        Joint(std::string(segment.name) + "_turn", UrdfJointType::kRevolute, parent, segment.name);
    joint.parent_from_joint = Translation(segment.from_parent);
    joint.axis = segment.axis;
    joint.lower = -3;
    joint.upper = 3;
    joint.effort = 120;
    joint.velocity = 2;
    arm.joints.push_back(joint);
    parent = segment.name;
  }
  AddFinger("thumb", 1, -0.03, arm);
  AddFinger("finger", -1, -0.01, arm);
  return arm;
}

}  // namespace doorforge
