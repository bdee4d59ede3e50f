// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/robot_model.h"

#include <algorithm>
#include <span>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"

#include "robot/level_postures.h"
#include "robot/self_collision.h"

namespace doorforge {
namespace {

int BaseJointCount(RobotBase base) {
  switch (base) {
    case RobotBase::kSliders:
      return kSliderCount;
    case RobotBase::kFixed:
      return 0;
    case RobotBase::kYaw:
      return kMostBaseJoints;
    case RobotBase::kFloating:
      return kFloatingJointCount;
  }
  return 0;
}

void RequireGripperArm(const RobotDescription& robot, int base_count) {
  const int count = static_cast<int>(robot.joints.size());
  const int arm_count = count - 2;
  const auto require = [&](bool good, const std::string& problem) {
    if (!good) throw Error(ErrorCode::kFormat, "robot \"" + robot.name + "\": " + problem);
  };
  const bool flies = robot.base == RobotBase::kFloating;
  const int arm_joints = arm_count - base_count;
  require(flies ? arm_joints == 0 : arm_joints >= 6 && arm_joints <= 8,
          std::to_string(arm_joints) + " arm joints, expected " + (flies ? "none" : "6 to 8"));
  const int sliders = flies ? 3 : std::min(base_count, kSliderCount);
  for (int i = 0; i < count; ++i) {
    const RobotJoint& joint = robot.joints[static_cast<std::size_t>(i)];
    const bool slides = i < sliders || i >= arm_count;
    const int parent = i < arm_count ? i - 1 : arm_count - 1;
    require(joint.prismatic == slides && joint.parent == parent,
            "joint \"" + joint.name + "\" is not of the kind or at the place of joint " +
                std::to_string(i) + "; see doorforge/physics/robot_model.h");
  }
  require(robot.hand.joint == arm_count - 1 && robot.tcp.joint == arm_count - 1,
          "hand and tool centre must be fixed to the last arm joint");
}

class Fingerprint {
 public:
  void Add(const std::string& text) { hash_.Update(text + '\n'); }
  template <class Derived>
  void Add(const Eigen::DenseBase<Derived>& numbers) {
    const typename Derived::PlainObject plain = numbers;
    hash_.Update(std::as_bytes(std::span(plain.data(), static_cast<std::size_t>(plain.size()))));
  }
  void Add(const RigidTransform& transform) { Add(transform.matrix()); }
  void Add(double number) { Add(Eigen::Matrix<double, 1, 1>(number)); }
  std::string HexDigest() { return hash_.HexDigest(); }

 private:
  Sha256 hash_;
};

void AddJoint(const RobotJoint& joint, Fingerprint& print) {
  print.Add(joint.name);
  print.Add(joint.parent_from_joint);
  print.Add(joint.axis);
  for (const double number :
       {joint.prismatic ? 1.0 : 0.0, static_cast<double>(joint.parent), joint.lower, joint.upper,
        joint.effort, joint.velocity, joint.mass.mass_kg})
    print.Add(number);
  print.Add(joint.mass.center_of_mass_m);
  print.Add(joint.mass.inertia_kg_m2);
}

std::string HashOf(const RobotDescription& robot) {
  Fingerprint print;
  print.Add(robot.name);
  for (const RobotJoint& joint : robot.joints) AddJoint(joint, print);
  for (const auto* pieces : {&robot.visuals, &robot.hulls}) {
    for (const RobotPiece& piece : *pieces) {
      print.Add(piece.name);
      print.Add(static_cast<double>(piece.joint));
      for (const Eigen::Vector3d& vertex : piece.mesh.vertices) print.Add(vertex);
      for (const Eigen::Vector3i& triangle : piece.mesh.triangles) print.Add(triangle);
    }
  }
  print.Add(robot.hand.body_from_frame);
  print.Add(robot.tcp.body_from_frame);
  print.Add(robot.rest);
  return print.HexDigest();
}

}  // namespace

RobotModel::RobotModel(RobotDescription description)
    : robot_(std::move(description)), base_count_(BaseJointCount(robot_.base)) {
  RequireGripperArm(robot_, base_count_);
  if (!robot_.name.empty()) sha256_ = HashOf(robot_);
  self_collisions_ = internal::SelfCollisionPairs(*this);
  level_postures_ = internal::LevelPostures(*this);
}

RigidTransform RobotModel::hand_from_tcp() const {
  return robot_.hand.body_from_frame.inverse() * robot_.tcp.body_from_frame;
}

RobotPose RobotModel::PoseAt(const JointVector& position,
                             const RigidTransform& world_from_base) const {
  RobotPose pose;
  pose.world_from_base = world_from_base;
  pose.world_from_body.reserve(robot_.joints.size());
  for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
    const RobotJoint& joint = robot_.joints[i];
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
  const RigidTransform& last = pose.world_from_body[static_cast<std::size_t>(arm_count()) - 1];
  pose.world_from_hand = last * robot_.hand.body_from_frame;
  pose.world_from_tcp = last * robot_.tcp.body_from_frame;
  return pose;
}

ArmJacobian RobotModel::TcpJacobian(const RobotPose& pose) const {
  ArmJacobian jacobian = ArmJacobian::Zero(6, arm_count());
  const Eigen::Vector3d point = pose.world_from_tcp.translation();
  for (int i = 0; i < arm_count(); ++i) {
    const RigidTransform& body = pose.world_from_body[static_cast<std::size_t>(i)];
    const Eigen::Vector3d axis = body.linear() * joint(i).axis;
    if (joint(i).prismatic) {
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
  for (int i = 0; i < joint_count(); ++i)
    clamped[i] = std::clamp(position[i], joint(i).lower, joint(i).upper);
  return clamped;
}

JointVector RobotModel::InitialPosition() const {
  JointVector position(joint_count());
  for (int i = 0; i < joint_count(); ++i)
    position[i] = i < arm_count() ? 0.3 * (joint(i).lower + joint(i).upper) : joint(i).upper;
  if (robot_.rest.size() > 0)
    position.segment(base_count_, arm_count() - base_count_) = robot_.rest;
  return position;
}

}  // namespace doorforge
