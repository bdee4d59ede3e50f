// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/rollout/handle_rule.h"

#include <gtest/gtest.h>

#include "doorforge/physics/scene_sampling.h"
#include "doorforge/rollout/expert_grasp.h"

#include "../physics/primitive_door.h"

namespace doorforge {
namespace {

// How far a hand has gone round the handle's axis from where it held the handle at rest.
double TurnOf(const RigidTransform& world_from_hand, const PrivilegedState& rest) {
  const RigidTransform hand_at_rest = rest.world_from_handle * rest.handle_from_hand_at_grasp;
  return RotationVector(world_from_hand.linear() * hand_at_rest.linear().transpose())
      .dot(rest.handle_axis_in_world);
}

class ExpertUnlockTest : public testing::Test {
 protected:
  ExpertUnlockTest() : door_(MakePrimitiveDoor({})), scene_(SampleScene(door_, 1, 0)) {
    const auto links = DoorFromLinks(door_, 0, 0);
    state_.world_from_handle = scene_.world_from_door * links[kHandleLink];
    state_.handle_axis_in_world = state_.world_from_handle.linear() * door_.handle_joint.axis;
    state_.handle_from_hand_at_grasp = door_.handle_from_grasp;
  }

  DoorAsset door_;
  Scene scene_;
  PrivilegedState state_;  // at rest
};

TEST_F(ExpertUnlockTest, TurnsAtItsSpeedAndNoFartherThanItsLeadOnAStuckHandle) {
  ExpertUnlock rule(scene_, door_);
  rule.Reset(state_);
  const double step = scene_.limits.turn_speed_rad_s * scene_.physics.time_step_s;
  double turned = 0;
  for (int i = 1; i <= 200; ++i) {
    turned = TurnOf(rule.Follow(state_), state_);
    EXPECT_NEAR(turned, std::min(i * step, scene_.limits.turn_lead_rad), 1e-9) << i;
  }
  EXPECT_NEAR(turned, 0.25, 1e-9);
}

TEST_F(ExpertUnlockTest, AimsALittlePastDoneAndNeverPastTheStop) {
  PrivilegedState now = state_;
  const auto farthest = [&] {
    ExpertUnlock rule(scene_, door_);
    rule.Reset(state_);
    double turned = 0;
    for (int i = 0; i < 2000; ++i) {
      turned = TurnOf(rule.Follow(now), state_);
      now.handle_rad = std::min(turned, door_.handle_joint.upper_rad);  // follows the hand
    }
    return turned;
  };
  const double lead = scene_.limits.turn_lead_rad;
  EXPECT_NEAR(farthest(), scene_.latch.handle_done_angle_rad + scene_.limits.turn_beyond_rad + lead,
              1e-9);
  scene_.limits.turn_beyond_rad = 2;
  now = state_;
  EXPECT_NEAR(farthest(), door_.handle_joint.upper_rad + lead, 1e-9);
}

TEST(ExpertGrasp, SaysWhereItsPlanTakesHold) {
  const RobotModel robot = LoadMobileFranka();
  const DoorAsset door = MakePrimitiveDoor({});
  const Scene scene = SampleScene(door, 1, 0);
  SceneSnapshot snapshot;
  const auto links = DoorFromLinks(door, 0, 0);
  for (std::size_t i = 0; i < links.size(); ++i)
    snapshot.door.at(i) = scene.world_from_door * links.at(i);
  const auto grasp = ExpertGrasp(scene, door, robot).Choose(snapshot);
  ASSERT_TRUE(grasp && grasp->plan);
  EXPECT_TRUE(grasp->both_pads);
  // the arm's posture is another way to say it
  const RobotPose pose = robot.PoseAt(grasp->plan->grasp, scene.world_from_robot_base);
  EXPECT_LT((pose.world_from_hand.linear() - grasp->world_from_hand_rotation).norm(), 0.02);
  const Eigen::Vector3d tip =
      pose.world_from_tcp.translation() - kGraspInsertion * pose.world_from_hand.linear().col(2);
  EXPECT_LT((tip - grasp->contact_m).norm(), 0.005);
}

}  // namespace
}  // namespace doorforge
