// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "../../train/learn/src/near_points.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/learn/stage_networks.h"

#include "../../train/learn/src/grasp_rating.h"
#include "door_cloud.h"

namespace doorforge::internal {
namespace {

TEST(NearPoints, AreTheNearestInOrderWithinTheHandsReachAndThenTheContactAgain) {
  const std::vector<float> xyz = {1, 2, 3, 1, 2.05F, 3, 1, 2, 3.02F, 1, 2, 2.8F, 1, 1.9F, 3};
  const Eigen::Matrix3Xf near = NearestToFirst(xyz, 6);
  ASSERT_EQ(near.cols(), 6);
  const float expected[6][3] = {{0, 0, 0},     {0, 0, 0.02F}, {0, 0.05F, 0},
                                {0, -0.1F, 0}, {0, 0, 0},     {0, 0, 0}};
  for (int i = 0; i < 6; ++i)
    EXPECT_LT((near.col(i) - Eigen::Map<const Eigen::Vector3f>(expected[i])).norm(), 1e-6) << i;
  EXPECT_LT((NearestToFirst(xyz, 2) - near.leftCols(2)).norm(), 1e-9);
  EXPECT_EQ(NearestToFirst(xyz, 0).cols(), 0);
}

TEST(NearPoints, AreSeenAlongTheFingersWhichMayStandAnyWay) {
  Eigen::Matrix3d world_from_hand;  // y, along which the fingers close, is up; z goes to -x
  world_from_hand.col(1) = Eigen::Vector3d::UnitZ();
  world_from_hand.col(2) = -Eigen::Vector3d::UnitX();
  world_from_hand.col(0) = world_from_hand.col(1).cross(world_from_hand.col(2));
  Eigen::Matrix3Xf near(3, 2);
  near.col(0) = Eigen::Vector3f(0, 0, 0.05F);
  near.col(1) = Eigen::Vector3f(0.1F, 0, 0);
  std::vector<float> seen = {7};
  AppendInHandFrame(near, world_from_hand, seen);
  const std::vector<float> expected = {7, 0, 1, 0, 0, 0, -2};
  ASSERT_EQ(seen.size(), expected.size());
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_NEAR(seen[i], expected[i], 1e-6) << i;

  const Eigen::Matrix3d turn = RotationAbout({0.6, 0, 0.8}, 1.1).linear();
  std::vector<float> turned = {7};
  AppendInHandFrame(turn.cast<float>() * near, turn * world_from_hand, turned);
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_NEAR(turned[i], seen[i], 1e-5) << i;
}

// All else cut out of the networks, what is left are the near points.
TEST(NearPoints, AloneTellTurnsOfTheHandApart) {
  StageNormalisation normalisation;
  normalisation.view.frame = ViewFrame::kHand;
  normalisation.action.deviation.fill(1);
  normalisation.score_rad.deviation.fill(1);
  normalisation.view.near_points = 64;
  StageNetworks networks = InitialNetworks(normalisation, false, 3, NetworkFamily::kGrasp);
  for (const DenseLayer& layer : CriticLayout(NetworkFamily::kGrasp).layers()) {
    if (layer.name.starts_with("near") || layer.name == "score.1") continue;
    for (int row = 0; row < layer.outputs; ++row) {
      for (int column = 0; column < layer.inputs; ++column) {
        if (layer.name == "score.0" && column >= layer.inputs - 128) continue;
        networks.critic[layer.offset + static_cast<std::size_t>(row * layer.inputs + column)] = 0;
      }
    }
  }
  const std::vector<float> cloud = testing::DoorCloud(5, 0);
  std::vector<Eigen::Matrix3d> turns;
  for (const double angle : {0.0, 0.7, std::numbers::pi})
    turns.emplace_back(RotationAbout(Eigen::Vector3d::UnitX(), angle).linear());
  turns.push_back(turns[1] * Eigen::Vector3d(-1, -1, 1).asDiagonal());
  const std::vector<float> ratings = GraspRater(networks).Rate(cloud, turns);
  EXPECT_GT(std::abs(ratings[0] - ratings[1]), 1e-5);
  EXPECT_NEAR(ratings[1], ratings[3], 1e-6) << "the other finger first";
  networks.normalisation.view.near_points = 0;
  const std::vector<float> blind = GraspRater(networks).Rate(cloud, turns);
  EXPECT_EQ(blind[0], blind[1]);
}

}  // namespace
}  // namespace doorforge::internal
