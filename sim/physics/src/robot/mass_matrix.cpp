// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/mass_matrix.h"

#include <vector>

namespace doorforge {
namespace {

using Twist = Eigen::Matrix<double, 6, 1>;           // angular, linear at the world's origin
using SpatialInertia = Eigen::Matrix<double, 6, 6>;  // the same order

Eigen::Matrix3d Cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d cross;
  cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return cross;
}

SpatialInertia InertiaOf(const MassProperties& body, const RigidTransform& world_from_body) {
  const Eigen::Matrix3d cross = Cross(world_from_body * body.center_of_mass_m);
  const Eigen::Matrix3d turned =
      world_from_body.linear() * body.inertia_kg_m2 * world_from_body.linear().transpose();
  SpatialInertia inertia;
  inertia.topLeftCorner<3, 3>() = turned + body.mass_kg * cross * cross.transpose();
  inertia.topRightCorner<3, 3>() = body.mass_kg * cross;
  inertia.bottomLeftCorner<3, 3>() = body.mass_kg * cross.transpose();
  inertia.bottomRightCorner<3, 3>() = body.mass_kg * Eigen::Matrix3d::Identity();
  return inertia;
}

Twist MotionOf(const RobotJoint& joint, const RigidTransform& world_from_body) {
  const Eigen::Vector3d axis = world_from_body.linear() * joint.axis;
  Twist motion = Twist::Zero();
  if (joint.prismatic) {
    motion.tail<3>() = axis;
  } else {
    motion.head<3>() = axis;
    motion.tail<3>() = world_from_body.translation().cross(axis);
  }
  return motion;
}

}  // namespace

JointMatrix MassMatrix(const RobotModel& robot, const RobotPose& pose,
                       std::span<const MassProperties> masses) {
  const int count = robot.joint_count();
  std::vector<SpatialInertia> composite;
  std::vector<Twist> motion;
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    composite.push_back(InertiaOf(masses[index], pose.world_from_body[index]));
    motion.push_back(MotionOf(robot.joint(i), pose.world_from_body[index]));
  }
  JointMatrix matrix = JointMatrix::Zero(count, count);
  for (int i = count - 1; i >= 0; --i) {
    const auto index = static_cast<std::size_t>(i);
    const int parent = robot.joint(i).parent;
    if (parent >= 0) composite[static_cast<std::size_t>(parent)] += composite[index];
    const Twist momentum = composite[index] * motion[index];
    for (int j = i; j >= 0; j = robot.joint(j).parent) {
      matrix(i, j) = motion[static_cast<std::size_t>(j)].dot(momentum);
      matrix(j, i) = matrix(i, j);
    }
  }
  return matrix;
}

JointMatrix MassMatrix(const RobotModel& robot, const RobotPose& pose) {
  std::vector<MassProperties> masses;
  for (const RobotJoint& joint : robot.joints()) masses.push_back(joint.mass);
  return MassMatrix(robot, pose, masses);
}

}  // namespace doorforge
