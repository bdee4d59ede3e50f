// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Robot and door in MuJoCo beside the same in Bullet.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/door_world.h"
#include "doorforge/physics/hand_controller.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/schemas/bolt.h"

#include "primitive_door.h"

namespace doorforge {
namespace {

constexpr Simulator kBoth[] = {Simulator::kBullet, Simulator::kMujoco};

Scene SceneIn(Simulator simulator, const DoorAsset& door) {
  SceneConfig config;
  config.base_jitter = 0;
  config.physics.simulator = simulator;
  return SampleScene(door, 1, 0, config);
}

// Hinge angles after each step of a pull that sets in within a second, the handle held turned.
std::vector<double> AnglesOf(Simulator simulator, const DoorAsset& door, const RobotModel& robot) {
  Scene scene = SceneIn(simulator, door);
  scene.world_from_robot_base.translation().x() += 5;  // out of the leaf's way
  DoorWorld world(scene, door, robot, robot.InitialPosition());
  const RobotCommand hold{robot.InitialPosition().head<kArmJointCount>()};
  const double turn =
      1.25 * scene.latch.handle_spring_nm_per_rad * scene.latch.handle_done_angle_rad;
  std::vector<double> angles;
  for (int i = 0; i < 720; ++i) {
    world.TurnHandle(turn * std::min(1.0, i / 120.0));
    world.PushLeaf({0, 0.7, 0}, {10 * std::clamp((i - 240) / 240.0, 0.0, 1.0), 0, 0});
    world.Step(hold);
    angles.push_back(world.state().hinge_rad);
  }
  EXPECT_FALSE(world.fault());
  return angles;
}

// It gives the same by the hinge's law of motion: inertia, damping and spring, steps of 10 us.
std::vector<double> AnglesByLaw(const DoorAsset& door) {
  constexpr int kParts = 400;
  const double dt = 1.0 / 240 / kParts;
  double angle = 0;
  double speed = 0;
  std::vector<double> angles;
  for (int i = 0; i < 720; ++i) {
    const double torque = 0.7 * 10 * std::clamp((i - 240) / 240.0, 0.0, 1.0);
    for (int k = 0; k < kParts; ++k) {
      speed +=
          dt *
          (torque - door.hinge.damping_nm_s * speed - door.latch.hinge_spring_nm_per_rad * angle) /
          InertiaAboutHinge(door);
      angle += dt * speed;
    }
    angles.push_back(angle);
  }
  return angles;
}

TEST(SecondSimulator, ADoorOpensOverTimeAsTheLawOfMotionSays) {
  const RobotModel robot = LoadMobileFranka();
  for (const Mechanism mechanism : {Mechanism::kLever, Mechanism::kRound, Mechanism::kNone}) {
    for (std::uint64_t i = 0; i < 3; ++i) {
      const DoorAsset door = MakePrimitiveDoor(RandomPrimitive(mechanism, 5, i));
      const std::vector<double> expected = AnglesByLaw(door);
      for (const Simulator simulator : kBoth) {
        const std::vector<double> angles = AnglesOf(simulator, door, robot);
        ASSERT_GT(angles.back(), 0.3);
        double worst = 0;
        for (std::size_t k = 0; k < angles.size(); ++k) {
          if (expected[k] > 0.1 && expected[k] < 0.9 * door.hinge.upper_rad)
            worst = std::max(worst, std::abs(angles[k] / expected[k] - 1));
        }
        EXPECT_LT(worst, 0.03) << NameOf(simulator) << ' ' << NameOf(mechanism) << ' ' << i;
      }
    }
  }
}

// Where the handle lets a loaded door go, turned slowly by a hand that knows its spring.
double UnlockAngle(Simulator simulator, const DoorAsset& door, const RobotModel& robot) {
  const Scene scene = SceneIn(simulator, door);
  DoorWorld world(scene, door, robot, robot.InitialPosition());
  const RobotCommand hold{robot.InitialPosition().head<kArmJointCount>()};
  double angle = 0;
  while (world.state().hinge_rad < 0.02 && angle < door.handle_joint.upper_rad) {
    angle += 0.15 * scene.physics.time_step_s;
    world.TurnHandle(scene.latch.handle_spring_nm_per_rad * angle +
                     10 * (angle - world.state().handle_rad) - 0.06 * world.state().handle_rad_s);
    const double reach = door.hinge_side == HingeSide::kLeft ? 0.7 : -0.7;
    world.PushLeaf({0, reach, 0}, {10, 0, 0});
    world.Step(hold);
  }
  EXPECT_FALSE(world.fault());
  return world.state().handle_rad;
}

TEST(SecondSimulator, LatchAndBoltLetGoAtTheirAngle) {
  constexpr double kThreeDegrees = 0.052;
  const RobotModel robot = LoadMobileFranka();
  for (const LatchType type : {LatchType::kEffort, LatchType::kBolt}) {
    for (const Mechanism mechanism : {Mechanism::kLever, Mechanism::kRound}) {
      for (const HingeSide side : {HingeSide::kLeft, HingeSide::kRight}) {
        DoorAsset door = MakePrimitiveDoor({.mechanism = mechanism, .hinge_side = side});
        door.latch.type = type;
        if (type == LatchType::kBolt) door.latch.bolt_throw_m = 0.012;
        for (const Simulator simulator : kBoth)
          EXPECT_NEAR(UnlockAngle(simulator, door, robot), door.latch.unlock_angle_rad,
                      kThreeDegrees)
              << NameOf(simulator) << ' ' << NameOf(type) << ' ' << NameOf(mechanism);
      }
    }
  }
}

TEST(SecondSimulator, ABoltHoldsTheDoorAndStaysThrown) {
  const RobotModel robot = LoadMobileFranka();
  DoorAsset door = MakePrimitiveDoor({});
  door.latch.type = LatchType::kBolt;
  door.latch.bolt_throw_m = 0.012;
  for (const Simulator simulator : kBoth) {
    DoorWorld world(SceneIn(simulator, door), door, robot, robot.InitialPosition());
    const RobotCommand hold{robot.InitialPosition().head<kArmJointCount>()};
    for (int i = 0; i < 480; ++i) {
      world.PushLeaf({0, 0.7, 0}, {60, 0, 0});
      world.Step(hold);
    }
    EXPECT_TRUE(world.state().locked) << NameOf(simulator);
    EXPECT_LT(world.state().hinge_rad, 0.01) << NameOf(simulator);
    EXPECT_NEAR(world.state().bolt_m, 0, 1e-3) << NameOf(simulator);
  }
}

// How far the hand is from its command on the way along a square, at worst.
double WorstError(Simulator simulator, const DoorAsset& door, const RobotModel& robot) {
  const Scene scene = SceneIn(simulator, door);
  DoorWorld world(scene, door, robot, robot.InitialPosition());
  HandController controller(robot, scene.world_from_robot_base, robot.InitialPosition());
  RigidTransform corner = controller.CommandedHand();
  double worst = 0;
  for (const Eigen::Vector3d& side : {Eigen::Vector3d(0, 0.1, 0), Eigen::Vector3d(0, 0, 0.1),
                                      Eigen::Vector3d(0, -0.1, 0), Eigen::Vector3d(0, 0, -0.1)}) {
    corner.translation() += side;
    controller.MoveHandTo(corner, 0.5);
    for (int i = 0; i < 150; ++i) {
      world.Step(controller.Step(world.state().robot_position, scene.physics.time_step_s));
      worst = std::max(worst, (world.PoseOfRobot().world_from_hand.translation() -
                               controller.CommandedHand().translation())
                                  .norm());
    }
  }
  EXPECT_FALSE(world.fault());
  return worst;
}

TEST(SecondSimulator, TheHandFollowsAsInBullet) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const double here = WorstError(Simulator::kBullet, door, robot);
  const double there = WorstError(Simulator::kMujoco, door, robot);
  EXPECT_LT(here, 0.008);
  EXPECT_NEAR(there, here, 0.001);
}

TEST(SecondSimulator, FingersOpenAsFarAsTheyAreAsked) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  for (const Simulator simulator : kBoth) {
    const Scene scene = SceneIn(simulator, door);
    DoorWorld world(scene, door, robot, robot.InitialPosition());
    RobotCommand command{robot.InitialPosition().head<kArmJointCount>()};
    for (const double asked_m : {0.012, 0.031}) {
      command.fingers_open_m = asked_m;
      for (int i = 0; i < 240; ++i) world.Step(command);
      for (const int finger : {robot.left_finger(), robot.right_finger()})
        EXPECT_NEAR(world.state().robot_position[finger], asked_m, 5e-4) << NameOf(simulator);
    }
    command.fingers_open_m.reset();
    for (int i = 0; i < 240; ++i) world.Step(command);
    EXPECT_NEAR(world.state().robot_position[robot.left_finger()],
                robot.joint(robot.left_finger()).upper, 5e-4)
        << NameOf(simulator);
  }
}

TEST(SecondSimulator, FingersMoveAtTheirSpeed) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  for (const Simulator simulator : kBoth) {
    const Scene scene = SceneIn(simulator, door);
    DoorWorld world(scene, door, robot, robot.InitialPosition());
    RobotCommand command{robot.InitialPosition().head<kArmJointCount>()};
    for (const bool close : {true, false}) {
      command.close_fingers = close;
      double fastest = 0;
      for (int i = 0; i < 240; ++i) {
        world.Step(command);
        fastest = std::max(fastest, std::abs(world.state().robot_velocity[robot.left_finger()]));
      }
      EXPECT_NEAR(fastest, 0.1, 0.005) << NameOf(simulator) << (close ? ", closing" : ", opening");
    }
  }
}

TEST(SecondSimulator, NoJointGoesFasterTowardsItsTargetThanIsAsked) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  for (const Simulator simulator : kBoth) {
    const Scene scene = SceneIn(simulator, door);
    const JointVector start = robot.InitialPosition();
    const auto fastest = [&](const std::optional<ArmVector>& most) {
      DoorWorld world(scene, door, robot, start);
      RobotCommand command{start.head<kArmJointCount>()};
      command.arm_position.array() -= 0.1;  // away from the door, and from the stops
      command.most_speed = most;
      double fastest = 0;
      for (int i = 0; i < 60; ++i) {
        world.Step(command);
        fastest = std::max(
            fastest, world.state().robot_velocity.head<kArmJointCount>().cwiseAbs().maxCoeff());
      }
      return fastest;
    };
    EXPECT_GT(fastest(std::nullopt), 1) << NameOf(simulator);
    EXPECT_NEAR(fastest(ArmVector::Constant(kArmJointCount, 0.2)), 0.2, 0.01) << NameOf(simulator);
  }
}

// Fingers in the air and on a bar: the force is what the drives give, friction the product.
TEST(SecondSimulator, PadsPressWithTheirForce) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({.mechanism = Mechanism::kNone});
  for (const Simulator simulator : kBoth) {
    SceneConfig config;
    config.base_jitter = config.grasp_noise = 0;
    config.physics.simulator = simulator;
    const Scene scene = SampleScene(door, 1, 0, config);
    const RigidTransform world_from_tcp =
        scene.world_from_door * DoorFromLinks(door, 0, 0)[kHandleLink] * door.handle_from_grasp;
    JointVector guess = robot.InitialPosition();
    guess[5] = -2.1;
    guess[7] = 3.37;
    guess[8] = -0.785;
    const auto solution =
        SolveInverseKinematics(robot, scene.world_from_robot_base, {world_from_tcp, guess}, guess);
    ASSERT_TRUE(solution.Reached());
    DoorWorld world(scene, door, robot, solution.position);
    const RobotCommand command{solution.position.head<kArmJointCount>(), true};
    for (int i = 0; i < 480; ++i) world.Step(command);
    const DoorContacts contacts = world.Contacts();
    ASSERT_TRUE(contacts.BothPads()) << NameOf(simulator);
    for (const double force : contacts.pad_force_n)
      EXPECT_NEAR(force, config.physics.finger_force_n, 0.15 * config.physics.finger_force_n)
          << NameOf(simulator);
    EXPECT_NEAR(contacts.pad_force_n[0] + contacts.pad_force_n[1],
                2 * config.physics.finger_force_n, 0.03 * config.physics.finger_force_n)
        << NameOf(simulator);
    EXPECT_LT(contacts.deepest_m, 0.0015) << NameOf(simulator);
    EXPECT_LT(contacts.force_on_door_n.norm(), 25) << NameOf(simulator);
    EXPECT_FALSE(world.fault());
  }
}

TEST(SecondSimulator, AJumpIsAFaultThereToo) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  DoorWorld world(SceneIn(Simulator::kMujoco, door), door, robot, robot.InitialPosition());
  const RobotCommand hold{robot.InitialPosition().head<kArmJointCount>()};
  for (int i = 0; i < 10; ++i) world.Step(hold);
  ASSERT_FALSE(world.fault());
  WorldState kicked = world.state();
  kicked.hinge_rad_s = 15;
  world.Place(kicked);
  world.Step(hold);
  ASSERT_TRUE(world.fault());
  EXPECT_EQ(world.fault()->kind, DivergenceKind::kEnergyGain);
  DoorWorld other(SceneIn(Simulator::kMujoco, door), door, robot, robot.InitialPosition());
  other.TurnHandle(1e5);
  other.Step(hold);
  ASSERT_TRUE(other.fault());
  EXPECT_EQ(other.fault()->kind, DivergenceKind::kTorque);
}

}  // namespace
}  // namespace doorforge
