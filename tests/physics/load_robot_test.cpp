// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/load_robot.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/inverse_kinematics.h"

#include "box_arm.h"

namespace doorforge {
namespace {

std::string MessageOf(const UrdfModel& urdf, const RobotSource& source = {}) {
  try {
    BuildRobot(urdf, source, RobotBase::kSliders);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(LoadRobot, FindsArmFingersAndToolOfAnArmOfAnotherMake) {
  const RobotModel robot = BuildRobot(BoxArm(), {}, RobotBase::kSliders);
  EXPECT_EQ(robot.base_count(), 2);
  EXPECT_EQ(robot.joint_count(), 10);
  EXPECT_EQ(robot.joint(2).name, "shoulder_turn");
  // whatever the URDF's convention: closed at 0
  for (const int finger : {robot.left_finger(), robot.right_finger()}) {
    EXPECT_EQ(robot.joint(finger).lower, 0);
    EXPECT_NEAR(robot.joint(finger).upper, 0.04, 1e-12);
  }
  const RobotPose closed =
      robot.PoseAt(JointVector::Zero(robot.joint_count()), RigidTransform::Identity());
  const RigidTransform tool_from_world = closed.world_from_tcp.inverse();
  for (const RobotPiece& piece : robot.hulls()) {
    if (piece.joint < robot.left_finger()) continue;
    const double side = piece.joint == robot.left_finger() ? 1 : -1;
    double inner = 1;
    double tip = -1;
    for (const Eigen::Vector3d& vertex : piece.mesh.vertices) {
      const Eigen::Vector3d in_tool =
          tool_from_world * closed.world_from_body[static_cast<std::size_t>(piece.joint)] * vertex;
      inner = std::min(inner, side * in_tool.y());
      tip = std::max(tip, in_tool.z());
    }
    EXPECT_NEAR(inner, 0, 1e-9);
    EXPECT_NEAR(tip, 0.0085, 1e-9);
  }
  // the hand's x is the approach
  EXPECT_NEAR(robot.hand_from_tcp().linear().col(2).x(), 1, 1e-9);
}

TEST(LoadRobot, ItsLevelPosturesReachBeforeTheRobot) {
  const RobotModel robot = BuildRobot(BoxArm(), {}, RobotBase::kSliders);
  for (const JointVector& posture : robot.level_postures()) {
    EXPECT_EQ(robot.Clamped(posture), posture);
    const RigidTransform tool = robot.PoseAt(posture, RigidTransform::Identity()).world_from_tcp;
    EXPECT_GT(tool.linear().col(2).x(), 0.99);
    EXPECT_GT(tool.translation().z(), 0.3);
  }
}

TEST(LoadRobot, StandsOnTheBaseThatIsAskedFor) {
  const RobotModel fixed = BuildRobot(BoxArm(), {}, RobotBase::kFixed);
  EXPECT_EQ(fixed.base_count(), 0);
  EXPECT_EQ(fixed.joint_count(), 8);
  const RobotModel yaw = BuildRobot(BoxArm(), {}, RobotBase::kYaw);
  EXPECT_EQ(yaw.base_count(), 3);
  EXPECT_FALSE(yaw.joint(2).prismatic);
  const RobotModel franka = LoadRobot({}, RobotBase::kYaw);
  EXPECT_EQ(franka.joint_count(), kRobotJointCount + 1);
  EXPECT_EQ(LoadRobot({}, RobotBase::kFixed).joint_count(), kRobotJointCount - kSliderCount);
  // its arm is where it is on sliders at rest
  const auto hand = [](const RobotModel& robot) {
    return robot.PoseAt(robot.InitialPosition(), RigidTransform::Identity()).world_from_hand;
  };
  EXPECT_TRUE(hand(franka).isApprox(hand(LoadMobileFranka()), 1e-12));
  EXPECT_FALSE(ValueNamed<RobotBase>("wheels").has_value());
}

// Closed form: with z ahead of the root at rest, yaw a and pitch b lead the approach to
// (cos a cos b, sin a cos b, -sin b), and roll leaves it where it is.
TEST(LoadRobot, LetsTheHandOfAnyRobotFly) {
  for (const RobotModel& robot :
       {LoadRobot({}, RobotBase::kFloating), BuildRobot(BoxArm(), {}, RobotBase::kFloating)}) {
    EXPECT_EQ(robot.joint_count(), 8);
    EXPECT_EQ(robot.base_count(), robot.arm_count());
    JointVector position = robot.InitialPosition();
    const auto tool = [&] {
      return robot.PoseAt(position, RigidTransform::Identity()).world_from_tcp;
    };
    EXPECT_TRUE(tool().linear().col(2).isApprox(Eigen::Vector3d::UnitX(), 1e-9));
    EXPECT_TRUE(tool().linear().col(1).isApprox(Eigen::Vector3d::UnitY(), 1e-9));
    position.head<6>() << 0.1, -0.2, 0.3, 0.4, 0.5, 0.6;
    EXPECT_TRUE(tool().linear().col(2).isApprox(
        Eigen::Vector3d(std::cos(0.4) * std::cos(0.5), std::sin(0.4) * std::cos(0.5),
                        -std::sin(0.5)),
        1e-9));
    // the shortest way between two level hands turned by 0.6 is a roll
    position.head<6>() << 0, 0, 0, 0, 0, 0.6;
    EXPECT_NEAR(std::acos(tool().linear().col(1).y()), 0.6, 1e-9);
  }
}

TEST(LoadRobot, AGripperWithoutAnArmCanOnlyFly) {
  UrdfModel gripper = BoxArm();
  std::erase_if(gripper.joints, [](const UrdfJoint& joint) { return joint.parent != "flange"; });
  std::erase_if(gripper.links, [](const UrdfLink& link) {
    return link.name != "flange" && link.name != "thumb" && link.name != "finger";
  });
  EXPECT_EQ(BuildRobot(gripper, {}, RobotBase::kFloating).joint_count(), 8);
  try {
    BuildRobot(gripper, {}, RobotBase::kSliders);
    FAIL() << "a gripper stands on sliders";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("can fly: physics.base: floating"), std::string::npos)
        << error.what();
  }
}

TEST(LoadRobot, TellsAllFaultsOfAUrdfAtOnce) {
  UrdfModel urdf = BoxArm();
  urdf.links[2].inertial.reset();
  urdf.joints[3].effort.reset();
  urdf.joints[4].velocity = 0;
  urdf.joints[1].upper = urdf.joints[1].lower;
  urdf.links[4].collisions[0].geometry = UrdfMeshFile{"package://nowhere/wrist.stl"};
  RobotSource source;
  source.options.tcp_link = "flang";
  const std::string message = MessageOf(urdf, source);
  for (const char* part :
       {"link \"upper\"", "no mass", "joint \"wrist1_turn\": `limit` has no effort",
        "joint \"wrist2_turn\": `limit` has no velocity", "joint \"upper_turn\": no range",
        "link \"wrist1\", collision: no file \"package://nowhere/wrist.stl\"",
        "tcp_link: \"flang\" is not in the URDF; the nearest is \"flange\""})
    EXPECT_NE(message.find(part), std::string::npos) << part << "\n" << message;
}

TEST(LoadRobot, RefusesFixedJointsThatGoRoundInACircle) {
  UrdfModel urdf = BoxArm();
  UrdfJoint back;
  back.name = "back";
  back.parent = urdf.joints.back().child;
  back.child = urdf.links[0].name;
  for (UrdfJoint& joint : urdf.joints) joint.type = UrdfJointType::kFixed;
  urdf.joints.back().type = UrdfJointType::kPrismatic;
  back.type = UrdfJointType::kFixed;
  urdf.joints.push_back(back);
  EXPECT_NE(MessageOf(urdf).find("every link has a parent"), std::string::npos);
}

// Asking at every joint what lies above every other takes the fourth power of their number.
TEST(LoadRobot, ATreeOfManyLinksIsToldToBeNoRobotAtOnce) {
  UrdfModel urdf = BoxArm();
  for (int i = 0; i < 1900; ++i) {
    UrdfLink link;
    link.name = "more" + std::to_string(i);
    UrdfJoint joint;
    joint.name = "joint" + std::to_string(i);
    joint.type = i < 950 ? UrdfJointType::kFixed : UrdfJointType::kPrismatic;
    joint.parent = urdf.links.back().name;
    joint.child = link.name;
    joint.upper = 1;
    urdf.links.push_back(link);
    urdf.joints.push_back(joint);
  }
  const std::clock_t begin = std::clock();
  EXPECT_NE(MessageOf(urdf).find("cannot be used"), std::string::npos);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 20);
}

TEST(LoadRobot, AsksForWhatTheTreeDoesNotTell) {
  UrdfModel urdf = BoxArm();
  urdf.joints.back().type = UrdfJointType::kFixed;
  EXPECT_NE(MessageOf(urdf).find("expected one pair of sliding joints"), std::string::npos);
  RobotSource source;
  source.options.fingers = {"thumb_slid", "finger_slide"};
  EXPECT_NE(MessageOf(BoxArm(), source).find("the nearest is \"thumb_slide\""), std::string::npos);
  urdf = BoxArm();
  urdf.joints[0].type = UrdfJointType::kFixed;
  EXPECT_NE(MessageOf(urdf).find("5 joints between the root and the hand, expected 6 to 8"),
            std::string::npos);
}

TEST(LoadRobot, ReadsOptionsBesideTheUrdf) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "box_arm";
  std::filesystem::create_directories(folder);
  UrdfModel urdf = BoxArm();
  for (UrdfLink& link : urdf.links) link.inertial.reset();
  std::ofstream(folder / "arm.urdf") << ToUrdf(urdf);
  std::ofstream(folder / "arm.robot.yaml")
      << "density_kg_m3: 1000\nrest_rad: [0, -1, 2, -1, 0, 0]\nfingers: [finger_slide, "
         "thumb_slide]\n";
  const RobotModel robot = LoadRobot(folder / "arm.urdf", RobotBase::kFixed);
  EXPECT_EQ(robot.name(), "box_arm");
  EXPECT_EQ(robot.InitialPosition()[2], 2);
  EXPECT_EQ(robot.joint(robot.left_finger()).name, "finger_slide");
  EXPECT_NEAR(robot.joint(1).mass.mass_kg, 1000 * 0.09 * 0.07 * 0.42, 1e-9);
  EXPECT_EQ(robot.sha256().size(), 64U);
  std::ofstream(folder / "arm.robot.yaml") << "densty_kg_m3: 1000\n";
  EXPECT_THROW(LoadRobot(folder / "arm.urdf", RobotBase::kFixed), Error);
  std::filesystem::remove_all(folder);
}

TEST(LoadRobot, OnlyTheBuiltInRobotHasNoHash) {
  EXPECT_TRUE(LoadMobileFranka().sha256().empty());
  const RobotModel one = BuildRobot(BoxArm(), {}, RobotBase::kSliders);
  EXPECT_EQ(BuildRobot(BoxArm(), {}, RobotBase::kSliders).sha256(), one.sha256());
  UrdfModel other = BoxArm();
  other.joints[0].upper = 2.9;
  EXPECT_NE(BuildRobot(other, {}, RobotBase::kSliders).sha256(), one.sha256());
}

}  // namespace
}  // namespace doorforge
