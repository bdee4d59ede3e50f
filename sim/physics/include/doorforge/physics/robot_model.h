// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "doorforge/core/mass_properties.h"
#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/urdf.h"

namespace doorforge {

/// The mobile gripper arm of UniDoorManip: joints 0 to 8 carry the hand (slider x, slider y, seven
/// arm joints), 9 and 10 are the left and the right finger.
inline constexpr int kRobotJointCount = 11;
inline constexpr int kArmJointCount = 9;
inline constexpr int kSliderCount = 2;
inline constexpr int kLeftFinger = 9;
inline constexpr int kRightFinger = 10;

/// One number a joint, in the order above [m or rad].
using JointVector = Eigen::Matrix<double, kRobotJointCount, 1>;
using ArmVector = Eigen::Matrix<double, kArmJointCount, 1>;
/// Twist of a frame [linear m; angular rad] per unit of each arm joint, in the world.
using ArmJacobian = Eigen::Matrix<double, 6, kArmJointCount>;

/// A moving joint and the body that hangs on it. The body's frame is the joint's frame after the
/// motion; URDF links that are fixed to each other are one body.
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
  MassProperties mass;  ///< Of the body, in its frame.
};

/// A piece of a body, in the body's frame.
struct RobotPiece {
  std::string name;
  int joint = -1;  ///< Whose body; -1: the base.
  TriangleMesh mesh;
  Eigen::Vector4d color_rgba{0.7, 0.7, 0.7, 1.0};
};

/// Where a URDF link's frame is: fixed to the body of a joint (-1: the base).
struct RobotFrame {
  int joint = -1;
  RigidTransform body_from_frame = RigidTransform::Identity();
};

/// Poses of the robot at one vector of joint positions, all in the world.
struct RobotPose {
  std::vector<RigidTransform> world_from_body;  ///< Length kRobotJointCount.
  RigidTransform world_from_hand = RigidTransform::Identity();
  /// Tool centre: midway between the pads, z the approach, y the direction in which they close.
  RigidTransform world_from_tcp = RigidTransform::Identity();
};

/// Kinematics, masses and shapes of the robot. Immutable; may be shared between threads.
class RobotModel {
 public:
  /// @param folder Meshes are looked up in it, in the canonical format; shapes other than meshes
  ///     are not supported. A mesh used for collision must be convex.
  /// @throws Error(kFormat) unless the model has exactly the 11 moving joints described above,
  ///     parents before children, and the links "panda_hand" and "panda_hand_tcp"; Error(kMissing)
  ///     if a mesh is missing.
  RobotModel(const UrdfModel& urdf, const std::filesystem::path& folder);

  const std::vector<RobotJoint>& joints() const { return joints_; }
  const std::vector<RobotPiece>& visuals() const { return visuals_; }
  const std::vector<RobotPiece>& hulls() const { return hulls_; }
  const RobotFrame& hand() const { return hand_; }
  const RobotFrame& tcp() const { return tcp_; }
  RigidTransform hand_from_tcp() const;

  RobotPose PoseAt(const JointVector& position, const RigidTransform& world_from_base) const;

  /// Jacobian of the tool centre at a pose of PoseAt().
  ArmJacobian TcpJacobian(const RobotPose& pose) const;

  /// Inside the joints' limits.
  JointVector Clamped(const JointVector& position) const;

  /// UniDoorManip's initial posture: 0.3 * (lower + upper), fingers open.
  JointVector InitialPosition() const;

 private:
  std::vector<RobotJoint> joints_;
  std::vector<RobotPiece> visuals_;
  std::vector<RobotPiece> hulls_;
  RobotFrame hand_;
  RobotFrame tcp_;
};

/// The robot in data/robots/mobile_franka. Throws as the constructor and ReadUrdf() do.
RobotModel LoadMobileFranka();

}  // namespace doorforge
