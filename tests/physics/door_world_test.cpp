// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/door_world.h"

#include <cmath>
#include <numbers>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/hand_controller.h"
#include "doorforge/physics/scene_sampling.h"

#include "primitive_door.h"

namespace doorforge {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// What holds of the world holds in every simulator.
class DoorWorldTest : public testing::TestWithParam<Simulator> {
 protected:
  DoorWorldTest() : robot_(LoadMobileFranka()), door_(MakePrimitiveDoor({})) {
    SceneConfig config;
    config.base_jitter = 0;
    config.physics.simulator = GetParam();
    scene_ = SampleScene(door_, 1, 0, config);
    hold_.arm_position = robot_.InitialPosition().head<kArmJointCount>();
  }

  DoorWorld MakeWorld() const { return {scene_, door_, robot_, robot_.InitialPosition()}; }

  // Pulls at the grasp point, out of the leaf.
  void Pull(DoorWorld& world, double newton, int steps) const {
    const Eigen::Vector3d point =
        door_.handle_joint.parent_from_child_at_zero * door_.handle_from_grasp.translation();
    for (int i = 0; i < steps; ++i) {
      world.PushLeaf(point, {newton, 0, 0});
      world.Step(hold_);
    }
  }

  RobotModel robot_;
  DoorAsset door_;
  Scene scene_;
  RobotCommand hold_;
};

TEST_P(DoorWorldTest, ALockedDoorHoldsAgainst100NewtonAtTheHandle) {
  DoorWorld world = MakeWorld();
  Pull(world, 100, 240);
  EXPECT_TRUE(world.state().locked);
  EXPECT_LT(world.state().hinge_rad, 1 * kDegree);
}

TEST_P(DoorWorldTest, TheLatchGivesWayWhereItsTorqueIsExceeded) {
  // the law is an effort: 150 N m at this reach is the force below, and no more
  const Eigen::Vector3d point =
      door_.handle_joint.parent_from_child_at_zero * door_.handle_from_grasp.translation();
  const double reach = point.y();
  DoorWorld below = MakeWorld();
  Pull(below, 0.97 * 150 / reach, 240);
  EXPECT_LT(below.state().hinge_rad, 1 * kDegree);
  DoorWorld above = MakeWorld();
  Pull(above, 1.10 * 150 / reach, 240);
  EXPECT_GT(above.state().hinge_rad, 2 * kDegree);
}

TEST_P(DoorWorldTest, WithTheHandleTurnedTheSamePullOpensIt) {
  DoorWorld world = MakeWorld();
  for (int i = 0; i < 240; ++i) {
    world.TurnHandle(5);
    world.Step(hold_);
  }
  EXPECT_FALSE(world.state().locked);
  EXPECT_TRUE(world.state().handle_done);
  EXPECT_NEAR(world.state().handle_rad, door_.handle_joint.upper_rad, 1 * kDegree);
  for (int i = 0; i < 60; ++i) {
    world.TurnHandle(5);
    Pull(world, 100, 1);
  }
  EXPECT_GT(world.state().hinge_rad, 5 * kDegree);
}

TEST_P(DoorWorldTest, AnOpenDoorStopsWhereItsSpringBalancesThePull) {
  scene_.latch.type = LatchType::kNone;
  DoorWorld world = MakeWorld();
  // hinge torque from a force along the leaf's normal: spring * angle in balance
  const double newton = 1.0;
  const Eigen::Vector3d point(0.02, 0.7, 0.8);
  for (int i = 0; i < 240 * 60; ++i) {
    world.PushLeaf(point, {newton, 0, 0});
    world.Step(hold_);
  }
  EXPECT_NEAR(world.state().hinge_rad, newton * 0.7 / scene_.latch.hinge_spring_nm_per_rad,
              0.2 * kDegree);
}

TEST_P(DoorWorldTest, TheHandleSpringsBack) {
  DoorWorld world = MakeWorld();
  for (int i = 0; i < 120; ++i) {
    world.TurnHandle(5);
    world.Step(hold_);
  }
  ASSERT_GT(world.state().handle_rad, 40 * kDegree);
  for (int i = 0; i < 240; ++i) world.Step(hold_);
  EXPECT_NEAR(world.state().handle_rad, 0, 0.5 * kDegree);
  EXPECT_TRUE(world.state().locked);
  EXPECT_TRUE(world.state().handle_done);
}

// Bullet's own limits let it through by one step's acceleration and then threw it back.
TEST_P(DoorWorldTest, ALeafThatTheLatchPullsShutStopsAtItsFrame) {
  // MuJoCo's stops are springs: 150 N m on this leaf press them in by this
  const double within = GetParam() == Simulator::kMujoco ? 3e-5 : 1e-6;
  const double slow = GetParam() == Simulator::kMujoco ? 1e-3 : 1e-6;
  DoorWorld world = MakeWorld();
  WorldState ajar = world.state();
  for (const double hinge_rad : {1e-12, 1e-6, 1e-3}) {
    ajar.hinge_rad = hinge_rad;
    world.Place(ajar);
    for (int i = 0; i < 24; ++i) {
      world.Step(hold_);
      ASSERT_GT(world.state().hinge_rad, -within) << "from " << hinge_rad << ", step " << i;
    }
    EXPECT_NEAR(world.state().hinge_rad, 0, within) << "from " << hinge_rad;
    EXPECT_NEAR(world.state().hinge_rad_s, 0, slow) << "from " << hinge_rad;
  }
}

TEST_P(DoorWorldTest, TheHandleTurnsAsItsSpringSays) {
  DoorWorld world = MakeWorld();
  const double torque = 1.2;
  for (int i = 0; i < 480; ++i) {
    world.TurnHandle(torque);
    world.Step(hold_);
  }
  EXPECT_NEAR(world.state().handle_rad, torque / scene_.latch.handle_spring_nm_per_rad,
              0.3 * kDegree);
}

TEST_P(DoorWorldTest, TheRobotHoldsStillAndFollowsItsJoints) {
  DoorWorld world = MakeWorld();
  for (int i = 0; i < 240; ++i) world.Step(hold_);
  EXPECT_LT((world.state().robot_position - robot_.InitialPosition()).cwiseAbs().maxCoeff(), 1e-3);
  RobotCommand command = hold_;
  command.arm_position[0] += 0.1;
  command.arm_position[8] += 0.3;
  for (int i = 0; i < 240; ++i) world.Step(command);
  EXPECT_LT((world.state().robot_position.head<kArmJointCount>() - command.arm_position)
                .cwiseAbs()
                .maxCoeff(),
            2e-3);
  EXPECT_FALSE(world.fault());
}

TEST_P(DoorWorldTest, FingersCloseOnNothingAndOpenAgain) {
  DoorWorld world = MakeWorld();
  RobotCommand close = hold_;
  close.close_fingers = true;
  for (int i = 0; i < 240; ++i) world.Step(close);
  EXPECT_NEAR(world.state().robot_position[kLeftFinger], 0, 1e-3);
  EXPECT_NEAR(world.state().robot_position[kRightFinger], 0, 1e-3);
  EXPECT_FALSE(world.Contacts().AnyPad());
  for (int i = 0; i < 240; ++i) world.Step(hold_);
  EXPECT_NEAR(world.state().robot_position[kLeftFinger], 0.04, 1e-3);
}

// Turns a knob by the wrist until the pads slip on it; the largest torque of its spring.
double LargestKnobTorque(Simulator simulator, double friction, const RobotModel& robot) {
  PrimitiveDoor shape;
  shape.mechanism = Mechanism::kRound;
  const DoorAsset door = MakePrimitiveDoor(shape);
  SceneConfig config;
  config.base_jitter = 0;
  config.grasp_noise = 0;
  config.physics.finger_friction = friction;
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
  EXPECT_TRUE(solution.Reached());
  DoorWorld world(scene, door, robot, solution.position);
  RobotCommand command{solution.position.head<kArmJointCount>(), true};
  // the wrist's axis is the approach, which points against the handle's
  const double way = -0.4 * scene.physics.time_step_s;
  double largest = 0;
  for (int i = 0; i < 960; ++i) {
    if (i > 120) command.arm_position[kArmJointCount - 1] += way;
    world.Step(command);
    largest = std::max(largest, world.state().handle_rad * scene.latch.handle_spring_nm_per_rad);
  }
  return largest;
}

TEST_P(DoorWorldTest, PadsTurnAKnobByCoulombFrictionAndNoMore) {
  // two pads of 80 N at 28 mm and the hulls' margin of 1 mm; the 48-gon's facets add up to 0.3 N m
  const double force_times_radius = 2 * 80 * 0.029;
  // MuJoCo's points lie at the very edges of a facet, and a little beyond
  const double facets = GetParam() == Simulator::kMujoco ? 0.55 : 0.35;
  for (const double friction : {0.02, 0.1, 0.3}) {
    const double torque = LargestKnobTorque(GetParam(), friction, robot_);
    EXPECT_GT(torque, 0.9 * friction * force_times_radius) << friction;
    EXPECT_LT(torque, friction * force_times_radius + facets) << friction;
  }
}

// Hash after 200 steps of a moving robot.
std::string HashOfRun(const Scene& scene, const DoorAsset& door, const RobotModel& robot) {
  DoorWorld world(scene, door, robot, robot.InitialPosition());
  HandController controller(robot, scene.world_from_robot_base, robot.InitialPosition());
  RigidTransform target = controller.CommandedHand();
  target.translation() += Eigen::Vector3d(-0.5, 0.2, 0.1);  // into the door
  controller.MoveHandTo(target, 0.3);
  for (int i = 0; i < 200; ++i)
    world.Step(controller.Step(world.state().robot_position, scene.physics.time_step_s));
  return world.StateHash();
}

TEST_P(DoorWorldTest, TheSameSceneGivesTheSameBitsAlsoInTwoThreads) {
  const std::string expected = HashOfRun(scene_, door_, robot_);
  EXPECT_EQ(HashOfRun(scene_, door_, robot_), expected);
  std::array<std::string, 2> hashes;
  std::thread first([&] { hashes[0] = HashOfRun(scene_, door_, robot_); });
  std::thread second([&] { hashes[1] = HashOfRun(scene_, door_, robot_); });
  first.join();
  second.join();
  EXPECT_EQ(hashes[0], expected);
  EXPECT_EQ(hashes[1], expected);
  Scene other = scene_;
  other.world_from_robot_base.translate(Eigen::Vector3d(1e-9, 0, 0));
  EXPECT_NE(HashOfRun(other, door_, robot_), expected);
}

TEST_P(DoorWorldTest, RefusesSettingsThatCannotBeStepped) {
  scene_.physics.time_step_s = 0;
  EXPECT_THROW(MakeWorld(), Error);
}

INSTANTIATE_TEST_SUITE_P(Simulators, DoorWorldTest,
                         testing::Values(Simulator::kBullet, Simulator::kMujoco),
                         [](const auto& tested) { return std::string(NameOf(tested.param)); });

}  // namespace
}  // namespace doorforge
