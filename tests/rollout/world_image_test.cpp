// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"
#include "doorforge/physics/door_world.h"
#include "doorforge/physics/hand_controller.h"
#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/grasp_plan.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

constexpr int kClosing = 200;  // steps
constexpr int kTurning = 240;
constexpr int kPulling = 240;
constexpr int kSteps = kClosing + kTurning + kPulling;

struct ImagedDoor {
  std::string name;
  Mechanism mechanism;
  LatchType latch;
  ArmController controller;
  Simulator simulator = Simulator::kBullet;
};

DoorAsset DoorOf(const ImagedDoor& kind, std::uint64_t index) {
  DoorAsset door = MakePrimitiveDoor(RandomPrimitive(kind.mechanism, 31, index));
  door.latch.type = kind.latch;
  if (kind.latch == LatchType::kBolt) door.latch.bolt_throw_m = 0.012;
  return door;
}

// Fingers close on the handle, the hand turns it and pulls the door open; what the drives were told
// on the way, and what every step came to.
struct Trace {
  std::vector<RobotCommand> commands;
  std::vector<std::string> hashes;
  bool was_locked = false;
  bool was_unlocked = false;
  bool touched = false;
};

class WorldImageTest : public testing::TestWithParam<ImagedDoor> {
 protected:
  WorldImageTest() : robot_(LoadMobileFranka()), door_(DoorOf(GetParam(), 1)) {
    SceneConfig config;
    config.physics.controller = GetParam().controller;
    config.physics.simulator = GetParam().simulator;
    scene_ = SampleScene(door_, 31, 1, config);
    plan_ = PlanGrasp(scene_, door_, robot_);
  }

  DoorWorld MakeWorld() const { return {scene_, door_, robot_, plan_.grasp}; }

  Trace RunOnce() const {
    DoorWorld world = MakeWorld();
    HandController controller(robot_, scene_.world_from_robot_base, plan_.grasp);
    controller.close_fingers = true;
    const RigidTransform handle_from_hand =
        world.WorldFromDoorLinks()[kHandleLink].inverse() * world.PoseOfRobot().world_from_hand;
    Trace run;
    for (int i = 0; i < kSteps; ++i) {
      const double turned =
          door_.handle_joint.upper_rad * std::clamp((i - kClosing) / double{kTurning}, 0.0, 1.0);
      if (i < kClosing + kTurning) {
        const auto links = DoorFromLinks(door_, world.state().hinge_rad, turned);
        controller.FollowHand(scene_.world_from_door * links[kHandleLink] * handle_from_hand);
      } else if (i == kClosing + kTurning) {
        RigidTransform back = controller.CommandedHand();
        back.translation().x() += 0.25;
        controller.MoveHandTo(back, 1);
      }
      run.commands.push_back(
          controller.Step(world.state().robot_position, scene_.physics.time_step_s));
      world.Step(run.commands.back());
      run.hashes.push_back(world.StateHash());
      run.was_locked |= world.state().locked;
      run.was_unlocked |= !world.state().locked;
      run.touched |= world.Contacts().BothPads();
    }
    EXPECT_FALSE(world.fault());
    return run;
  }

  // The first step from `from` on after which the world is not where it was.
  static int FirstDifference(DoorWorld& world, const Trace& run, int from) {
    for (int i = from; i < kSteps; ++i) {
      const auto at = static_cast<std::size_t>(i);
      world.Step(run.commands[at]);
      if (world.StateHash() != run.hashes[at]) return i;
    }
    return -1;
  }

  RobotModel robot_;
  DoorAsset door_;
  Scene scene_;
  GraspPlan plan_;
};

TEST_P(WorldImageTest, TheSameCommandsGiveTheSameBitsAfterComingBack) {
  const Trace run = RunOnce();
  ASSERT_TRUE(run.touched);
  if (GetParam().latch != LatchType::kNone) {
    ASSERT_TRUE(run.was_locked && run.was_unlocked);
  }
  DoorWorld world = MakeWorld();
  std::vector<std::pair<int, WorldImage>> images;
  for (int i = 0; i < kSteps; ++i) {
    if (i % 85 == 0) images.emplace_back(i, world.Save());
    const auto at = static_cast<std::size_t>(i);
    world.Step(run.commands[at]);
    ASSERT_EQ(world.StateHash(), run.hashes[at]) << "saving has changed step " << i;
  }
  // backwards, forwards, and from wherever the one before has left the world
  for (std::size_t k = images.size(); k-- > 0;) {
    world.Restore(images[k].second);
    EXPECT_EQ(FirstDifference(world, run, images[k].first), -1) << "from step " << images[k].first;
  }
  for (const auto& [step, image] : images) {
    world.Restore(image);
    // somewhere else first: the hand lets go
    RobotCommand open = run.commands[static_cast<std::size_t>(step)];
    open.close_fingers = false;
    for (int i = 0; i < 60; ++i) world.Step(open);
    world.Restore(image);
    EXPECT_EQ(FirstDifference(world, run, step), -1) << "from step " << step;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, WorldImageTest,
    testing::Values(
        ImagedDoor{"lever", Mechanism::kLever, LatchType::kEffort, ArmController::kJointMotors},
        ImagedDoor{"round", Mechanism::kRound, LatchType::kEffort, ArmController::kJointMotors},
        ImagedDoor{"bolt", Mechanism::kLever, LatchType::kBolt, ArmController::kJointMotors},
        ImagedDoor{"torques", Mechanism::kLever, LatchType::kEffort,
                   ArmController::kOperationalSpace},
        ImagedDoor{"none", Mechanism::kNone, LatchType::kNone, ArmController::kJointMotors},
        ImagedDoor{"lever_mujoco", Mechanism::kLever, LatchType::kEffort,
                   ArmController::kJointMotors, Simulator::kMujoco},
        ImagedDoor{"bolt_mujoco", Mechanism::kLever, LatchType::kBolt, ArmController::kJointMotors,
                   Simulator::kMujoco},
        ImagedDoor{"torques_mujoco", Mechanism::kRound, LatchType::kEffort,
                   ArmController::kOperationalSpace, Simulator::kMujoco}),
    [](const auto& info) { return info.param.name; });

TEST(WorldImage, IsOfItsOwnWorldAlone) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  DoorWorld world(scene, door, robot, robot.InitialPosition());
  DoorWorld other(scene, door, robot, robot.InitialPosition());
  const WorldImage image = world.Save();
  EXPECT_GT(image.size_bytes(), 10'000U);
  EXPECT_LT(image.size_bytes(), 10'000'000U);
  EXPECT_THROW(other.Restore(image), Error);
  EXPECT_THROW(world.Restore(WorldImage()), Error);
  DoorWorld moved = std::move(world);
  EXPECT_NO_THROW(moved.Restore(image));
}

TEST(WorldImage, AFaultIsForgottenWithTheStateThatHadIt) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  DoorWorld world(scene, door, robot, robot.InitialPosition());
  RobotCommand hold{robot.InitialPosition().head<kArmJointCount>()};
  for (int i = 0; i < 5; ++i) world.Step(hold);
  const WorldImage image = world.Save();
  world.Step(hold);
  const std::string expected = world.StateHash();
  RobotCommand wrong = hold;
  wrong.arm_position[0] = std::nan("");
  world.Step(wrong);
  ASSERT_TRUE(world.fault());
  world.Restore(image);
  EXPECT_FALSE(world.fault());
  world.Step(hold);
  EXPECT_EQ(world.StateHash(), expected);
}

}  // namespace
}  // namespace doorforge
