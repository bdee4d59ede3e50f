// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "doorforge/core/mass_properties.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/robot_base.h"

namespace doorforge {

/// A gripper arm on a base: first the base's joints (none, slider x and slider y, or these and a
/// yaw), then 6 to 8 arm joints, then the left and the right finger. The first two kinds carry the
/// hand and are called arm joints together where numbers a joint are meant. A flying hand has
/// sliders x, y and z, then yaw, pitch and roll, as its base's joints and no others before the
/// fingers.
inline constexpr int kMostBaseJoints = 3;  ///< Below an arm.
inline constexpr int kFloatingJointCount = 6;
inline constexpr int kMostArmJoints = kMostBaseJoints + 8;
inline constexpr int kMostRobotJoints = kMostArmJoints + 2;

/// The built-in robot on its sliders, LoadMobileFranka(), has so many.
inline constexpr int kRobotJointCount = 11;
inline constexpr int kArmJointCount = 9;
inline constexpr int kSliderCount = 2;
inline constexpr int kLeftFinger = 9;
inline constexpr int kRightFinger = 10;

/// One number a joint, in the order above [m or rad]; as long as RobotModel::joint_count().
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostRobotJoints, 1>;
/// It leaves out the fingers and is RobotModel::arm_count() long.
using ArmVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostArmJoints, 1>;
/// Twist of a frame [linear m; angular rad] per unit of each arm joint, in the world.
using ArmJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMostArmJoints>;

/// A moving joint and the body that hangs on it. The body's frame is the joint's frame after the
/// motion; links that are fixed to each other are one body.
struct RobotJoint {
  std::string name;
  bool prismatic = false;
  int parent = -1;  ///< Joint whose body carries this one; -1: the robot's base.
  RigidTransform parent_from_joint = RigidTransform::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< Unit, in the joint's frame.
  double lower = 0;
  double upper = 0;
  double effort = 0;    ///< [N m] or [N]
  double velocity = 0;  ///< [rad/s] or [m/s]
  MassProperties mass;  ///< It is the body's, in the body's frame.
};

/// A piece of a body, in the body's frame.
struct RobotPiece {
  std::string name;
  int joint = -1;  ///< Whose body; -1: the base.
  TriangleMesh mesh;
  Eigen::Vector4d color_rgba{0.7, 0.7, 0.7, 1.0};
};

/// A frame that is fixed to the body of a joint (-1: the base).
struct RobotFrame {
  int joint = -1;
  RigidTransform body_from_frame = RigidTransform::Identity();
};

/// Poses of the robot at one vector of joint positions, all in the world.
struct RobotPose {
  RigidTransform world_from_base = RigidTransform::Identity();
  std::vector<RigidTransform> world_from_body;  ///< There is one a joint: its body's.
  RigidTransform world_from_hand = RigidTransform::Identity();
  /// Tool centre: midway between the pads, z the approach, y the direction in which they close.
  RigidTransform world_from_tcp = RigidTransform::Identity();
};

/// Kinematics, masses and shapes of a robot, as RobotModel takes them.
struct RobotDescription {
  std::string name;  ///< Empty: the built-in robot.
  RobotBase base = RobotBase::kSliders;
  std::vector<RobotJoint> joints;  ///< In the order above, parents before children.
  std::vector<RobotPiece> visuals;
  std::vector<RobotPiece> hulls;  ///< Convex.
  RobotFrame hand;                ///< On the last arm joint's body.
  RobotFrame tcp;                 ///< It is fixed to the same joint.
  ArmVector rest;  ///< Posture of the arm without base joints; empty: none of its own.
};

/// Kinematics, masses and shapes of the robot. Immutable; may be shared between threads.
class RobotModel {
 public:
  /// @throws Error(kFormat) unless the joints are of the kinds and in the order described above.
  explicit RobotModel(RobotDescription description);

  /// Empty for the built-in robot.
  const std::string& name() const { return robot_.name; }
  /// SHA-256 over name, kinematics, masses and shapes, bit by bit; empty for the built-in robot.
  const std::string& sha256() const { return sha256_; }

  RobotBase base() const { return robot_.base; }
  int base_count() const { return base_count_; }       ///< 0, 2 or 3; 6 of a flying hand.
  int arm_count() const { return joint_count() - 2; }  ///< With the base's joints.
  int joint_count() const { return static_cast<int>(robot_.joints.size()); }
  int left_finger() const { return arm_count(); }
  int right_finger() const { return arm_count() + 1; }

  const std::vector<RobotJoint>& joints() const { return robot_.joints; }
  const RobotJoint& joint(int index) const {
    return robot_.joints[static_cast<std::size_t>(index)];
  }
  const std::vector<RobotPiece>& visuals() const { return robot_.visuals; }
  const std::vector<RobotPiece>& hulls() const { return robot_.hulls; }
  const RobotFrame& hand() const { return robot_.hand; }
  const RobotFrame& tcp() const { return robot_.tcp; }
  RigidTransform hand_from_tcp() const;

  /// Which bodies can collide with each other, as pairs of joints, the lower first: all but
  /// neighbours and those whose hulls meet in the initial posture, in half of all postures, or, one
  /// body apart, in any.
  const std::vector<std::pair<int, int>>& self_collisions() const { return self_collisions_; }

  /// Postures with a level hand before the robot: where inverse kinematics begins.
  const std::vector<JointVector>& level_postures() const { return level_postures_; }

  RobotPose PoseAt(const JointVector& position, const RigidTransform& world_from_base) const;

  /// Jacobian of the tool centre at a pose of PoseAt().
  ArmJacobian TcpJacobian(const RobotPose& pose) const;

  /// Inside the joints' limits.
  JointVector Clamped(const JointVector& position) const;

  /// The robot's own rest posture where it has one, else UniDoorManip's: 0.3 * (lower + upper).
  /// Fingers open, base in the middle.
  JointVector InitialPosition() const;

 private:
  RobotDescription robot_;
  int base_count_ = 0;
  std::string sha256_;
  std::vector<std::pair<int, int>> self_collisions_;
  std::vector<JointVector> level_postures_;
};

/// The robot in data/robots/mobile_franka on its sliders.
RobotModel LoadMobileFranka();

}  // namespace doorforge
