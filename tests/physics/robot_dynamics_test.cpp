// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// What acts on the robot's joints: torques, limits, the robot itself.

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/door_world.h"
#include "doorforge/physics/hand_controller.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"

#include "box_arm.h"
#include "primitive_door.h"

namespace doorforge {
namespace {

// A scene with the robot out of the door's reach.
Scene EmptyScene(const DoorAsset& door, const RobotModel& robot, ArmController controller) {
  SceneConfig config;
  config.physics.base = robot.base();
  config.physics.controller = controller;
  Scene scene = SampleScene(door, 1, 0, config);
  scene.world_from_robot_base = Translation({5, 0, 0.1});
  return scene;
}

struct LineErrors {
  double beside_m = 0;
  double end_m = 0;
  double end_rad = 0;
};

LineErrors FollowLine(const RobotModel& robot, ArmController controller) {
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = EmptyScene(door, robot, controller);
  const JointVector start = robot.level_postures().front();
  DoorWorld world(scene, door, robot, start);
  HandController hand(robot, scene.world_from_robot_base, start);
  const Eigen::Vector3d from = hand.CommandedHand().translation();
  RigidTransform target = hand.CommandedHand();
  const Eigen::Vector3d way(-0.1, 0.2, 0.1);
  target.translation() += way;
  hand.MoveHandTo(target, 1);
  LineErrors errors;
  for (int i = 0; i < 360; ++i) {
    world.Step(hand.Step(world.state().robot_position, scene.physics.time_step_s));
    const Eigen::Vector3d gone = world.PoseOfRobot().world_from_hand.translation() - from;
    errors.beside_m = std::max(errors.beside_m, gone.cross(way.normalized()).norm());
  }
  const RigidTransform end = world.PoseOfRobot().world_from_hand;
  errors.end_m = (end.translation() - target.translation()).norm();
  errors.end_rad = RotationVector(end.linear() * target.linear().transpose()).norm();
  EXPECT_FALSE(world.fault());
  return errors;
}

TEST(OperationalSpace, LeadsTheHandAlongAStraightLine) {
  const RobotModel box = BuildRobot(BoxArm(), {}, RobotBase::kSliders);
  for (const RobotModel& robot : {LoadMobileFranka(), LoadRobot({}, RobotBase::kFixed),
                                  LoadRobot({}, RobotBase::kYaw), box}) {
    const LineErrors errors = FollowLine(robot, ArmController::kOperationalSpace);
    EXPECT_LT(errors.beside_m, 0.005) << robot.name() << ' ' << NameOf(robot.base());
    EXPECT_LT(errors.end_m, 0.002) << robot.name() << ' ' << NameOf(robot.base());
    EXPECT_LT(errors.end_rad, 0.01) << robot.name() << ' ' << NameOf(robot.base());
  }
}

TEST(OperationalSpace, TorquesOfTheUrdfAreItsLimit) {
  // a wrist of 12 N m on the tool's axis: pushed against a wall it would need more
  UrdfModel weak = BoxArm();
  for (UrdfJoint& joint : weak.joints) {
    if (joint.effort) joint.effort = 0.02;
  }
  const RobotModel robot = BuildRobot(weak, {}, RobotBase::kFixed);
  EXPECT_GT(FollowLine(robot, ArmController::kOperationalSpace).end_m, 0.05);
}

TEST(OperationalSpace, AnotherBaseIsRefused) {
  const DoorAsset door = MakePrimitiveDoor({});
  const RobotModel robot = LoadMobileFranka();
  Scene scene = EmptyScene(door, robot, ArmController::kJointMotors);
  scene.physics.base = RobotBase::kFixed;
  EXPECT_THROW(DoorWorld(scene, door, robot, robot.InitialPosition()), Error);
}

struct Stop {
  double beyond = 0;    // of the limit, at rest
  double peak = 0;      // the same, as it arrives
  bool itself = false;  // the robot was in its own way
};

// Drives one joint far beyond a limit.
Stop StopsAt(const RobotModel& robot, const Scene& scene, const DoorAsset& door, int joint,
             double way) {
  JointVector start = robot.InitialPosition();
  const double limit = way > 0 ? robot.joint(joint).upper : robot.joint(joint).lower;
  start[joint] = limit - 0.1 * way;
  DoorWorld world(scene, door, robot, start);
  RobotCommand command;
  command.arm_position = start.head(robot.arm_count());
  command.arm_position[joint] = limit + 0.1 * way;
  Stop stop;
  for (int i = 0; i < 600; ++i) {
    world.Step(command);
    stop.beyond = way * (world.state().robot_position[joint] - limit);
    stop.peak = std::max(stop.peak, stop.beyond);
    stop.itself = stop.itself || world.Contacts().self_points > 0;
  }
  return stop;
}

TEST(JointLimits, StopEveryJointThatIsPushedAgainstThem) {
  const DoorAsset door = MakePrimitiveDoor({});
  const RobotModel robot = LoadMobileFranka();
  for (const ArmController controller :
       {ArmController::kJointMotors, ArmController::kOperationalSpace}) {
    const Scene scene = EmptyScene(door, robot, controller);
    for (int joint = 0; joint < robot.arm_count(); ++joint) {
      for (const double way : {-1.0, 1.0}) {
        const Stop stop = StopsAt(robot, scene, door, joint, way);
        const std::string where = std::string(NameOf(controller)) + ", joint " +
                                  std::to_string(joint) + (way > 0 ? ", upper" : ", lower");
        EXPECT_LT(stop.beyond, 0.01) << where;
        EXPECT_LT(stop.peak, 0.1) << where;
        EXPECT_TRUE(stop.itself || stop.beyond > -0.01) << where << ' ' << stop.beyond;
      }
    }
  }
}

TEST(SelfCollision, AFoldedArmStopsAtItself) {
  const DoorAsset door = MakePrimitiveDoor({});
  const RobotModel robot = LoadMobileFranka();
  const Scene scene = EmptyScene(door, robot, ArmController::kJointMotors);
  JointVector start = robot.level_postures().front();
  DoorWorld world(scene, door, robot, start);
  HandController hand(robot, scene.world_from_robot_base, start);
  JointVector folded = start;
  folded[3] = -1.7;  // shoulder back
  folded[5] = -3.0;  // elbow closed: the hand comes down on the platform or the shoulder
  folded[7] = 0.2;
  DoorContacts most;
  for (int i = 0; i < 960; ++i) {
    world.Step(
        hand.StepJoints(folded, world.state().robot_position, scene.physics.time_step_s, 0.5));
    const DoorContacts contacts = world.Contacts();
    if (contacts.self_points > most.self_points) most = contacts;
  }
  EXPECT_GT(most.self_points, 0);
  EXPECT_FALSE(most.self_touches.empty());
  EXPECT_EQ(most.arm_points, 0);
  EXPECT_GT((world.state().robot_position - folded).head(robot.arm_count()).cwiseAbs().maxCoeff(),
            0.05);
}

TEST(SelfCollision, NeighboursAndFingersDoNotCount) {
  const RobotModel robot = LoadMobileFranka();
  for (const auto& [first, second] : robot.self_collisions()) {
    EXPECT_LT(first, second);
    EXPECT_NE(robot.joint(second).parent, first);
    EXPECT_NE(robot.joint(second).parent, robot.joint(first).parent);
  }
  // hand and forearm of the elbow against platform, shoulder and upper arm at least
  EXPECT_GT(robot.self_collisions().size(), 10U);
}

TEST(SelfCollision, TheInitialPostureTouchesNothing) {
  const DoorAsset door = MakePrimitiveDoor({});
  for (const RobotModel& robot :
       {LoadMobileFranka(), BuildRobot(BoxArm(), {}, RobotBase::kSliders)}) {
    DoorWorld world(EmptyScene(door, robot, ArmController::kJointMotors), door, robot,
                    robot.InitialPosition());
    RobotCommand hold;
    hold.arm_position = robot.InitialPosition().head(robot.arm_count());
    for (int i = 0; i < 24; ++i) world.Step(hold);
    EXPECT_EQ(world.Contacts().self_points, 0) << world.Contacts().self_touches;
  }
}

}  // namespace
}  // namespace doorforge
