// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/robot_model.h"

#include <array>
#include <numbers>

#include <gtest/gtest.h>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/error.h"
#include "doorforge/core/rng.h"
#include "doorforge/physics/load_robot.h"

namespace doorforge {
namespace {

JointVector RandomPosition(const RobotModel& robot, std::uint64_t index) {
  Rng rng(3, "robot/" + std::to_string(index));
  JointVector position(robot.joint_count());
  for (int i = 0; i < kRobotJointCount; ++i) {
    const RobotJoint& joint = robot.joints()[static_cast<std::size_t>(i)];
    position[i] = rng.Uniform(joint.lower, joint.upper);
  }
  return position;
}

// Pose of the flange by Craig's convention from Franka's published table (a, d, alpha).
RigidTransform FlangeByDenavitHartenberg(const JointVector& position) {
  constexpr double kRight = std::numbers::pi / 2;
  constexpr std::array<std::array<double, 3>, 8> kTable = {{{0, 0.333, 0},
                                                            {0, 0, -kRight},
                                                            {0, 0.316, kRight},
                                                            {0.0825, 0, kRight},
                                                            {-0.0825, 0.384, -kRight},
                                                            {0, 0, kRight},
                                                            {0.088, 0, kRight},
                                                            {0, 0.107, 0}}};
  RigidTransform pose = Translation({position[0], position[1], 0});
  for (std::size_t i = 0; i < kTable.size(); ++i) {
    const auto& [a, d, alpha] = kTable.at(i);
    const double theta = i < 7 ? position[static_cast<Eigen::Index>(i) + kSliderCount] : 0;
    pose = pose * RotationAbout(Eigen::Vector3d::UnitX(), alpha) * Translation({a, 0, 0}) *
           RotationAbout(Eigen::Vector3d::UnitZ(), theta) * Translation({0, 0, d});
  }
  return pose;
}

TEST(RobotModel, HandIsWhereThePublishedDenavitHartenbergTablePutsIt) {
  const RobotModel robot = LoadMobileFranka();
  for (std::uint64_t i = 0; i < 20; ++i) {
    const JointVector position = RandomPosition(robot, i);
    const RigidTransform expected = FlangeByDenavitHartenberg(position) *
                                    RotationAbout(Eigen::Vector3d::UnitZ(), -std::numbers::pi / 4);
    const RobotPose pose = robot.PoseAt(position, RigidTransform::Identity());
    EXPECT_LT((pose.world_from_hand.matrix() - expected.matrix()).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((pose.world_from_tcp.translation() - expected * Eigen::Vector3d(0, 0, 0.1034)).norm(),
              1e-9);
  }
}

TEST(RobotModel, JacobianIsTheDerivativeOfTheToolCentre) {
  const RobotModel robot = LoadMobileFranka();
  const RigidTransform base = FromXyzRpy({0.7, 0.1, 0.1}, {0, 0, 3});
  constexpr double kStep = 1e-6;
  for (std::uint64_t i = 0; i < 5; ++i) {
    const JointVector position = RandomPosition(robot, i);
    const RobotPose pose = robot.PoseAt(position, base);
    const ArmJacobian jacobian = robot.TcpJacobian(pose);
    for (int joint = 0; joint < kArmJointCount; ++joint) {
      JointVector moved = position;
      moved[joint] += kStep;
      const RigidTransform after = robot.PoseAt(moved, base).world_from_tcp;
      const Eigen::Vector3d linear =
          (after.translation() - pose.world_from_tcp.translation()) / kStep;
      const Eigen::Vector3d angular =
          RotationVector(after.linear() * pose.world_from_tcp.linear().transpose()) / kStep;
      EXPECT_LT((linear - jacobian.col(joint).head<3>()).norm(), 1e-5) << joint;
      EXPECT_LT((angular - jacobian.col(joint).tail<3>()).norm(), 1e-5) << joint;
    }
  }
}

TEST(RobotModel, LimitsAndEffortsAreThePublishedOnes) {
  const RobotModel robot = LoadMobileFranka();
  const double upper[] = {1,      1,      2.8973, 1.7628, 2.8973, -0.0698,
                          2.8973, 3.7525, 2.8973, 0.04,   0.04};
  const double effort[] = {87, 87, 87, 87, 12, 12, 12};
  for (std::size_t i = 0; i < kRobotJointCount; ++i)
    EXPECT_DOUBLE_EQ(robot.joints()[i].upper, upper[i]) << robot.joints()[i].name;
  for (std::size_t i = 0; i < 7; ++i)
    EXPECT_DOUBLE_EQ(robot.joints()[i + kSliderCount].effort, effort[i]);
  const JointVector initial = robot.InitialPosition();
  EXPECT_NEAR(initial[5], -0.9425, 1e-4);  // UniDoorManip's initial posture
  EXPECT_NEAR(initial[7], 1.1205, 1e-4);
  EXPECT_DOUBLE_EQ(initial[kLeftFinger], 0.04);
}

TEST(RobotModel, PadsMeetInTheMiddleAtFingerPositionZero) {
  const RobotModel robot = LoadMobileFranka();
  const RobotPose pose =
      robot.PoseAt(JointVector::Zero(robot.joint_count()), RigidTransform::Identity());
  const RigidTransform tcp_from_world = pose.world_from_tcp.inverse();
  for (const RobotPiece& piece : robot.hulls()) {
    if (piece.joint < kArmJointCount) continue;
    const double side = piece.joint == kLeftFinger ? 1 : -1;
    double nearest = 1;
    double tip = -1;
    for (const Eigen::Vector3d& vertex : piece.mesh.vertices) {
      const Eigen::Vector3d in_tcp =
          tcp_from_world * pose.world_from_body[static_cast<std::size_t>(piece.joint)] * vertex;
      nearest = std::min(nearest, side * in_tcp.y());
      tip = std::max(tip, in_tcp.z());
    }
    EXPECT_NEAR(nearest, 0, 1e-9);
    EXPECT_GT(tip, 0.005);  // the tool centre lies between the pads
  }
}

TEST(RobotModel, EveryMeshIsClosedAndEveryHullSmallAndConvex) {
  const RobotModel robot = LoadMobileFranka();
  for (const RobotPiece& piece : robot.visuals()) EXPECT_TRUE(ClosedMesh::From(piece.mesh));
  ASSERT_FALSE(robot.hulls().empty());
  for (const RobotPiece& piece : robot.hulls()) {
    ASSERT_TRUE(ClosedMesh::From(piece.mesh)) << piece.name;
    EXPECT_LE(piece.mesh.vertices.size(), 40U);
    for (const Eigen::Vector3i& t : piece.mesh.triangles) {
      const auto at = [&](int i) { return piece.mesh.vertices[static_cast<std::size_t>(t[i])]; };
      const Eigen::Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
      for (const Eigen::Vector3d& vertex : piece.mesh.vertices)
        EXPECT_LT(normal.dot(vertex - at(0)), 5e-6) << piece.name;
    }
  }
}

TEST(RobotModel, RefusesARobotOfAnotherKind) {
  UrdfModel urdf;
  urdf.name = "stick";
  urdf.links.resize(1);
  urdf.links[0].name = "base";
  EXPECT_THROW(BuildRobot(urdf, {}, RobotBase::kSliders), Error);
}

}  // namespace
}  // namespace doorforge
