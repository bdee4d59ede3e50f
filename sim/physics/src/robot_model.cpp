// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/robot_model.h"

#include <algorithm>
#include <map>

#include "doorforge/core/error.h"
#include "doorforge/core/program.h"
#include "doorforge/schemas/mesh_file.h"

namespace doorforge {
namespace {

[[noreturn]] void Fail(const UrdfModel& urdf, const std::string& problem) {
  throw Error(ErrorCode::kFormat, "robot \"" + urdf.name + "\": " + problem);
}

RobotJoint ToJoint(const UrdfJoint& joint, const RobotFrame& parent) {
  RobotJoint result;
  result.name = joint.name;
  result.prismatic = joint.type == UrdfJointType::kPrismatic;
  result.parent = parent.joint;
  result.parent_from_joint = parent.body_from_frame * joint.parent_from_joint;
  result.axis = joint.axis.normalized();
  result.lower = joint.lower;
  result.upper = joint.upper;
  result.effort = joint.effort.value_or(0);
  result.velocity = joint.velocity.value_or(0);
  return result;
}

// Frames of all links, and the moving joints in tree order (siblings in file order).
struct Tree {
  std::map<std::string, RobotFrame> frames;
  std::vector<RobotJoint> joints;
};

void AddChildren(const UrdfModel& urdf, const std::string& link, Tree& tree) {
  for (const UrdfJoint& joint : urdf.joints) {
    if (joint.parent != link) continue;
    const RobotFrame& parent = tree.frames.at(link);
    if (joint.type == UrdfJointType::kFixed) {
      tree.frames[joint.child] = {parent.joint, parent.body_from_frame * joint.parent_from_joint};
    } else {
      tree.joints.push_back(ToJoint(joint, parent));
      tree.frames[joint.child] = {static_cast<int>(tree.joints.size()) - 1,
                                  RigidTransform::Identity()};
    }
    AddChildren(urdf, joint.child, tree);
  }
}

RobotPiece ToPiece(const UrdfShape& shape, const RobotFrame& frame,
                   const std::filesystem::path& folder) {
  const auto* file = std::get_if<UrdfMeshFile>(&shape.geometry);
  if (file == nullptr)
    throw Error(ErrorCode::kFormat, "robot shape \"" + shape.name + "\" is not a mesh");
  RobotPiece piece;
  piece.name = shape.name;
  piece.joint = frame.joint;
  piece.mesh = ReadObj(folder / file->filename);
  const RigidTransform body_from_shape = frame.body_from_frame * shape.link_from_shape;
  for (Eigen::Vector3d& vertex : piece.mesh.vertices)
    vertex = body_from_shape * vertex.cwiseProduct(file->scale).eval();
  if (shape.color_rgba) piece.color_rgba = *shape.color_rgba;
  return piece;
}

void RequireGripperArm(const UrdfModel& urdf, const std::vector<RobotJoint>& joints) {
  if (joints.size() != kRobotJointCount)
    Fail(urdf, "has " + std::to_string(joints.size()) +
                   " moving joints, expected 11: two sliders, "
                   "seven arm joints, two fingers");
  for (int i = 0; i < kRobotJointCount; ++i) {
    const RobotJoint& joint = joints[static_cast<std::size_t>(i)];
    const bool slides = i < kSliderCount || i >= kArmJointCount;
    const int parent = i < kArmJointCount ? i - 1 : kArmJointCount - 1;
    if (joint.prismatic != slides || joint.parent != parent)
      Fail(urdf, "joint \"" + joint.name + "\" is not of the kind or at the place of joint " +
                     std::to_string(i) + "; see doorforge/physics/robot_model.h");
  }
}

}  // namespace

RobotModel::RobotModel(const UrdfModel& urdf, const std::filesystem::path& folder) {
  Tree tree;
  const std::string root = RootLinkOf(urdf);
  tree.frames[root] = {};
  AddChildren(urdf, root, tree);
  RequireGripperArm(urdf, tree.joints);

  std::vector<std::vector<MassProperties>> masses(tree.joints.size());
  for (const UrdfLink& link : urdf.links) {
    const RobotFrame& frame = tree.frames.at(link.name);
    if (link.inertial && frame.joint >= 0)
      masses[static_cast<std::size_t>(frame.joint)].push_back(
          Transformed(*link.inertial, frame.body_from_frame));
    for (const UrdfShape& shape : link.visuals) visuals_.push_back(ToPiece(shape, frame, folder));
    for (const UrdfShape& shape : link.collisions) hulls_.push_back(ToPiece(shape, frame, folder));
  }
  for (std::size_t i = 0; i < masses.size(); ++i) tree.joints[i].mass = Combined(masses[i]);

  joints_ = std::move(tree.joints);
  for (const char* name : {"panda_hand", "panda_hand_tcp"}) {
    const auto frame = tree.frames.find(name);
    if (frame == tree.frames.end() || frame->second.joint != kArmJointCount - 1)
      Fail(urdf,
           std::string("link \"") + name + "\" is missing or not fixed to the last arm joint");
  }
  hand_ = tree.frames.at("panda_hand");
  tcp_ = tree.frames.at("panda_hand_tcp");
}

RigidTransform RobotModel::hand_from_tcp() const {
  return hand_.body_from_frame.inverse() * tcp_.body_from_frame;
}

RobotPose RobotModel::PoseAt(const JointVector& position,
                             const RigidTransform& world_from_base) const {
  RobotPose pose;
  pose.world_from_body.reserve(joints_.size());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const RobotJoint& joint = joints_[i];
    const double q = position[static_cast<Eigen::Index>(i)];
    RigidTransform world_from_joint =
        (joint.parent < 0 ? world_from_base
                          : pose.world_from_body[static_cast<std::size_t>(joint.parent)]) *
        joint.parent_from_joint;
    if (joint.prismatic) {
      world_from_joint.translate(joint.axis * q);
    } else {
      world_from_joint.rotate(Eigen::AngleAxisd(q, joint.axis));
    }
    pose.world_from_body.push_back(world_from_joint);
  }
  const RigidTransform& last = pose.world_from_body[kArmJointCount - 1];
  pose.world_from_hand = last * hand_.body_from_frame;
  pose.world_from_tcp = last * tcp_.body_from_frame;
  return pose;
}

ArmJacobian RobotModel::TcpJacobian(const RobotPose& pose) const {
  ArmJacobian jacobian = ArmJacobian::Zero();
  const Eigen::Vector3d point = pose.world_from_tcp.translation();
  for (int i = 0; i < kArmJointCount; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const RigidTransform& body = pose.world_from_body[index];
    const Eigen::Vector3d axis = body.linear() * joints_[index].axis;
    if (joints_[index].prismatic) {
      jacobian.col(i).head<3>() = axis;
    } else {
      jacobian.col(i).head<3>() = axis.cross(point - body.translation());
      jacobian.col(i).tail<3>() = axis;
    }
  }
  return jacobian;
}

JointVector RobotModel::Clamped(const JointVector& position) const {
  JointVector clamped = position;
  for (int i = 0; i < kRobotJointCount; ++i) {
    const RobotJoint& joint = joints_[static_cast<std::size_t>(i)];
    clamped[i] = std::clamp(position[i], joint.lower, joint.upper);
  }
  return clamped;
}

JointVector RobotModel::InitialPosition() const {
  JointVector position;
  for (int i = 0; i < kRobotJointCount; ++i) {
    const RobotJoint& joint = joints_[static_cast<std::size_t>(i)];
    position[i] = i < kArmJointCount ? 0.3 * (joint.lower + joint.upper) : joint.upper;
  }
  return position;
}

RobotModel LoadMobileFranka() {
  const std::filesystem::path folder = DataFolder() / "robots" / "mobile_franka";
  return {ReadUrdf(folder / "mobile_franka.urdf"), folder};
}

}  // namespace doorforge
