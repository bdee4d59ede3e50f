// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/hand_controller.h"

#include <gtest/gtest.h>

#include "doorforge/physics/door_world.h"
#include "doorforge/physics/scene_sampling.h"

#include "primitive_door.h"

namespace doorforge {
namespace {

TEST(HandController, TheSimulatedHandArrivesWhereItWasSent) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  const JointVector start = robot.InitialPosition();
  DoorWorld world(scene, door, robot, start);
  HandController controller(robot, scene.world_from_robot_base, start);
  RigidTransform target = controller.CommandedHand();
  target.translation() += Eigen::Vector3d(0.2, -0.1, -0.15);
  target.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  controller.MoveHandTo(target, 0.5);
  for (int i = 0; i < 240; ++i)
    world.Step(controller.Step(world.state().robot_position, scene.physics.time_step_s));
  const RigidTransform hand = world.PoseOfRobot().world_from_hand;
  EXPECT_LT((hand.translation() - target.translation()).norm(), 2e-3);
  EXPECT_LT(RotationVector(hand.linear() * target.linear().transpose()).norm(), 0.01);
}

TEST(HandController, KeepsTheSpeedLimits) {
  const RobotModel robot = LoadMobileFranka();
  const RigidTransform base = RigidTransform::Identity();
  HandController controller(robot, base, robot.InitialPosition());
  RigidTransform target = controller.CommandedHand();
  target.translation().x() += 0.3;
  controller.MoveHandTo(target, 0.0);
  JointVector measured = robot.InitialPosition();
  const double dt = 1.0 / 240;
  int steps = 0;
  for (; !controller.Arrived() && steps < 1000; ++steps) {
    const Eigen::Vector3d before = controller.CommandedHand().translation();
    const RobotCommand command = controller.Step(measured, dt);
    EXPECT_LE((controller.CommandedHand().translation() - before).norm(), 0.6 * dt * 1.01);
    for (int i = 0; i < kArmJointCount; ++i) {
      const double limit = robot.joints()[static_cast<std::size_t>(i)].velocity;
      EXPECT_LE(std::abs(command.arm_position[i] - measured[i]), limit * dt * 1.01);
    }
    measured.head<kArmJointCount>() = command.arm_position;
  }
  EXPECT_NEAR(steps, 120, 1);  // 0.3 m at 0.6 m/s
}

TEST(HandController, JointMotionEndsAtItsTargetTogether) {
  const RobotModel robot = LoadMobileFranka();
  HandController controller(robot, RigidTransform::Identity(), robot.InitialPosition());
  JointVector target = robot.InitialPosition();
  target[2] += 1.0;
  target[7] -= 0.5;
  JointVector measured = robot.InitialPosition();
  for (int i = 0; i < 400; ++i)
    measured.head<kArmJointCount>() =
        controller.StepJoints(target, measured, 1.0 / 240, 0.5).arm_position;
  EXPECT_LT((measured - target).cwiseAbs().maxCoeff(), 1e-6);
}

// Sent half a second ahead while something holds the arm.
JointVector HeldUp(HandController& controller, const JointVector& measured) {
  RigidTransform target = controller.CommandedHand();
  target.translation().x() += 0.2;
  controller.MoveHandTo(target, 0.4);
  for (int i = 0; i < 120; ++i) controller.Step(measured, 1.0 / 240);
  return measured;
}

TEST(HandController, AfterAStopNothingThatWasCommandedAheadIsLeft) {
  const RobotModel robot = LoadMobileFranka();
  HandController controller(robot, RigidTransform::Identity(), robot.InitialPosition());
  const JointVector measured = HeldUp(controller, robot.InitialPosition());
  const auto lead = [&] {
    const RobotCommand command = controller.Step(measured, 1.0 / 240);
    return (command.arm_position - measured.head<kArmJointCount>()).cwiseAbs().maxCoeff();
  };
  EXPECT_GT(lead(), 0.05);
  controller.StopAt(measured);
  EXPECT_LT(lead(), 1e-9);
}

// Each joint alone, by what its own turning or sliding moves the tool centre.
TEST(HandController, CatchesUpNoFasterThanItIsTold) {
  const RobotModel robot = LoadMobileFranka();
  const JointVector start = robot.InitialPosition();
  HandControllerConfig config;
  config.catch_up = 0.1;
  HandController controller(robot, RigidTransform::Identity(), start, config);
  const auto fastest_m_s = [&](const RobotCommand& command) {
    double fastest = 0;
    for (int i = 0; i < kArmJointCount; ++i) {
      const double step = 1e-6;
      JointVector moved = start;
      moved[i] += step;
      const auto tool = [&](const JointVector& at) {
        return Eigen::Vector3d(
            robot.PoseAt(at, RigidTransform::Identity()).world_from_tcp.translation());
      };
      const double way = (tool(moved) - tool(start)).norm() / step;
      fastest = std::max(fastest, way * command.most_speed.value()[i]);
    }
    return fastest;
  };
  RigidTransform target = controller.CommandedHand();
  target.translation().x() += 0.2;
  controller.MoveHandTo(target, 0.4);
  EXPECT_NEAR(fastest_m_s(controller.Step(start, 1.0 / 240)), 0.2 / 0.4 + 0.1, 1e-3);
  for (int i = 0; i < 120; ++i) controller.Step(start, 1.0 / 240);  // something holds it up
  EXPECT_NEAR(fastest_m_s(controller.Step(start, 1.0 / 240)), 0.1, 1e-3);
  HandController free(robot, RigidTransform::Identity(), start);
  EXPECT_FALSE(free.Step(start, 1.0 / 240).most_speed);
}

}  // namespace
}  // namespace doorforge
