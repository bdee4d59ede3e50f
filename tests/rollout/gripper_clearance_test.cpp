// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/gripper_clearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/rng.h"
#include "doorforge/physics/grasp_probe.h"
#include "doorforge/physics/robot_model.h"
#include "doorforge/rollout/grasp_plan.h"
#include "doorforge/rollout/run_episode.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

// The hand looks along the world's x, its fingers close along the world's y.
const Eigen::Matrix3d kLevel = (Eigen::Matrix3d() << 0, 0, 1, 0, 1, 0, -1, 0, 0).finished();

void Add(LabelledCloud& cloud, const Eigen::Vector3d& point_m) {
  for (const double coordinate : point_m) cloud.xyz.push_back(static_cast<float>(coordinate));
  cloud.label.push_back(0);
}

// Before a hand with its contact at the origin.
LabelledCloud Wall(double x_m) {
  LabelledCloud cloud;
  for (double y = -0.15; y <= 0.15; y += 0.003)
    for (double z = -0.15; z <= 0.15; z += 0.003) Add(cloud, {x_m, y, z});
  return cloud;
}

LabelledCloud Stud(double y_m, double from_x_m) {
  LabelledCloud cloud;
  for (double x = from_x_m; x <= 0.02; x += 0.001) Add(cloud, {x, y_m, 0});
  return cloud;
}

// How far the fingers reach past the contact, and where the palm begins.
struct Reach {
  double tip_m = 0;
  double palm_m = 0;
};
Reach ReachOf(const RobotModel& robot) {
  const RobotPose pose = robot.PoseAt(robot.InitialPosition(), RigidTransform::Identity());
  double tip = 0;
  double palm = 0;
  for (const RobotPiece& piece : robot.hulls()) {
    if (piece.joint < robot.hand().joint) continue;
    const RigidTransform hand_from_body =
        pose.world_from_hand.inverse() *
        pose.world_from_body[static_cast<std::size_t>(piece.joint)];
    double& farthest = piece.joint == robot.hand().joint ? palm : tip;
    for (const Eigen::Vector3d& vertex : piece.mesh.vertices)
      farthest = std::max(farthest, (hand_from_body * vertex).z());
  }
  const double contact = robot.hand_from_tcp().translation().z() - kGraspInsertion;
  return {tip - contact, palm - contact};
}

TEST(GripperClearance, TheFingersStopAtAWall) {
  const RobotModel robot = LoadMobileFranka();
  const GripperClearance clearance(robot);
  const double tip = ReachOf(robot).tip_m;
  EXPECT_GT(tip, 0.01);
  EXPECT_TRUE(clearance.Fits(Wall(tip + 0.001), Eigen::Vector3d::Zero(), kLevel));
  EXPECT_TRUE(clearance.Fits(Wall(tip - 0.002), Eigen::Vector3d::Zero(), kLevel)) << "it grazes";
  EXPECT_FALSE(clearance.Fits(Wall(tip - 0.006), Eigen::Vector3d::Zero(), kLevel));
  EXPECT_FALSE(clearance.Fits(Wall(-0.1), Eigen::Vector3d::Zero(), kLevel)) << "passed on the way";
  EXPECT_TRUE(clearance.Fits(Wall(tip - 0.006), {-0.01, 0, 0}, kLevel)) << "farther back";
}

TEST(GripperClearance, WhatStandsBetweenTheFingersMayReachUpToThePalm) {
  const RobotModel robot = LoadMobileFranka();
  const GripperClearance clearance(robot);
  const double palm = ReachOf(robot).palm_m;
  EXPECT_LT(palm, -0.02);
  EXPECT_TRUE(clearance.Fits(Stud(0, palm), Eigen::Vector3d::Zero(), kLevel));
  EXPECT_FALSE(clearance.Fits(Stud(0, palm - 0.02), Eigen::Vector3d::Zero(), kLevel));
  EXPECT_FALSE(clearance.Fits(Stud(0.045, palm), Eigen::Vector3d::Zero(), kLevel)) << "in a finger";
  EXPECT_TRUE(clearance.Fits(Stud(0.2, -0.15), Eigen::Vector3d::Zero(), kLevel)) << "beside it";
  LabelledCloud noise;
  Add(noise, {-0.1, 0, 0});
  Add(noise, {-0.1, 0.001, 0});
  EXPECT_TRUE(clearance.Fits(noise, Eigen::Vector3d::Zero(), kLevel));
}

std::vector<TriangleMesh> HullsOf(const DoorLink& link) {
  std::vector<TriangleMesh> hulls;
  for (const DoorGeometry& geometry : link.geometry)
    hulls.insert(hulls.end(), geometry.hulls.begin(), geometry.hulls.end());
  return hulls;
}

// Every surface of the door's hulls, one point in 9 mm^2.
LabelledCloud SurfaceOf(const DoorAsset& door, Rng& rng) {
  LabelledCloud cloud;
  const auto links = DoorFromLinks(door, 0, 0);
  for (std::size_t link = 0; link < links.size(); ++link)
    for (const TriangleMesh& hull : HullsOf(door.links.at(link)))
      for (const Eigen::Vector3i& triangle : hull.triangles) {
        std::array<Eigen::Vector3d, 3> corner;
        for (std::size_t k = 0; k < 3; ++k)
          corner.at(k) =
              links.at(link) *
              hull.vertices[static_cast<std::size_t>(triangle[static_cast<Eigen::Index>(k)])];
        const Eigen::Vector3d u = corner[1] - corner[0];
        const Eigen::Vector3d v = corner[2] - corner[0];
        const double area = u.cross(v).norm() / 2;
        for (double placed = 0; placed < area; placed += 9e-6) {
          double a = rng.Uniform();
          double b = rng.Uniform();
          if (a + b > 1) a = 1 - a, b = 1 - b;
          Add(cloud, corner[0] + a * u + b * v);
        }
      }
  return cloud;
}

constexpr double kFrankaOpen = 0.04;  // [m]

// Smallest distance on the straight way in, by the physics' own shapes.
double ClearanceOnTheWay(const GraspProbe& probe, const RigidTransform& door_from_tcp) {
  double least = std::numeric_limits<double>::infinity();
  for (double back = 0; back <= kPregraspDistance; back += 0.004) {
    RigidTransform at = door_from_tcp;
    at.translation() -= back * door_from_tcp.linear().col(2);
    least = std::min(least, probe.Clearance(at, kFrankaOpen, 0.02));
  }
  return least;
}

TEST(GripperClearance, AgreesWithThePhysicsWhereAllIsSeen) {
  const RobotModel robot = LoadMobileFranka();
  const GripperClearance clearance(robot);
  DoorAsset door = MakePrimitiveDoor({.width_m = 0.3, .height_m = 0.4, .handle_height_m = 0.2});
  const GraspProbe probe(door, robot);
  Rng rng(1, "test");
  const LabelledCloud surface = SurfaceOf(door, rng);
  const RigidTransform grasp = DoorFromLinks(door, 0, 0)[kHandleLink] * door.handle_from_grasp;
  int fitted = 0;
  int blocked = 0;
  for (int i = 0; i < 200; ++i) {
    RigidTransform tcp = grasp;
    tcp.linear() *= RotationAbout(Eigen::Vector3d::UnitZ(), rng.Uniform(-1.6, 1.6)).linear();
    tcp.translation() +=
        grasp.linear() * Eigen::Vector3d(rng.Uniform(-0.06, 0.06), rng.Uniform(-0.06, 0.06),
                                         rng.Uniform(-0.05, 0.03));
    const double depth = ClearanceOnTheWay(probe, tcp);
    const Eigen::Matrix3d hand = tcp.linear() * robot.hand_from_tcp().linear().transpose();
    const bool fits =
        clearance.Fits(surface, tcp.translation() - kGraspInsertion * hand.col(2), hand);
    if (depth > 0) {
      EXPECT_TRUE(fits) << depth;
      ++fitted;
    } else if (depth < -0.01) {
      EXPECT_FALSE(fits) << depth;
      ++blocked;
    }
  }
  EXPECT_GT(fitted, 10);
  EXPECT_GT(blocked, 10);
}

}  // namespace
}  // namespace doorforge
