// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/grasp_probe.h"

#include <gtest/gtest.h>

#include "primitive_door.h"

namespace doorforge {
namespace {

class GraspProbeTest : public testing::Test {
 protected:
  GraspProbeTest()
      : robot_(LoadMobileFranka()), door_(MakePrimitiveDoor({})), probe_(door_, robot_) {
    door_from_grasp_ = DoorFromLinks(door_, 0, 0)[kHandleLink] * door_.handle_from_grasp;
  }
  RobotModel robot_;
  DoorAsset door_;
  GraspProbe probe_;
  RigidTransform door_from_grasp_;
};

TEST_F(GraspProbeTest, PadsMeetABarAtHalfItsThickness) {
  for (const int finger : {kLeftFinger, kRightFinger}) {
    const auto contact = probe_.Close(door_from_grasp_, finger);
    ASSERT_TRUE(contact);
    EXPECT_NEAR(contact->finger_position_m, 0.01, 0.0025);  // margins of 1 mm on either side
    EXPECT_NEAR(std::abs(contact->normal_in_tcp.y()), 1, 1e-3);
    EXPECT_GT(contact->normal_in_tcp.y() * (finger == kLeftFinger ? 1 : -1), 0);
  }
}

TEST_F(GraspProbeTest, AShiftedHandMeetsTheBarUnevenly) {
  const RigidTransform shifted = door_from_grasp_ * Translation({0, 0.005, 0});
  const auto left = probe_.Close(shifted, kLeftFinger);
  const auto right = probe_.Close(shifted, kRightFinger);
  ASSERT_TRUE(left && right);
  EXPECT_NEAR(left->finger_position_m - right->finger_position_m, -0.010, 5e-4);
}

TEST_F(GraspProbeTest, AFingerThatPassesTheHandleTouchesNothing) {
  EXPECT_FALSE(probe_.Close(door_from_grasp_ * Translation({0, 0, -0.1}), kLeftFinger));
}

TEST_F(GraspProbeTest, ClearanceIsTheGapToTheLeafAndNegativeInside) {
  // the tips reach 8.5 mm past the tool centre; the leaf's surface is 55 mm behind the bar
  for (const double open_m : {0.04, 0.025}) {
    const double at_grasp = probe_.Clearance(door_from_grasp_, open_m, 0.2);
    EXPECT_NEAR(at_grasp, open_m - 0.01, 0.005);  // open pads to the bar
    EXPECT_LT(probe_.Clearance(door_from_grasp_ * Translation({0, 0, 0.06}), open_m, 0.2), 0);
    EXPECT_NEAR(probe_.Clearance(door_from_grasp_ * Translation({0, 0, -0.5}), open_m, 0.2), 0.2,
                1e-12);
  }
}

}  // namespace
}  // namespace doorforge
