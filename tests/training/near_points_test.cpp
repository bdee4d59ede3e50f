// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/networks/near_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/networks/stage_networks.h"
#include "doorforge/policy/grasp_rating.h"

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

// Sum of the sides of the boxes about each dozen of points, one after the other.
float SizeOfDozens(const Eigen::Matrix3Xf& points) {
  float size = 0;
  for (Eigen::Index first = 0; first + 12 <= points.cols(); first += 12) {
    const auto dozen = points.middleCols(first, 12);
    size += (dozen.rowwise().maxCoeff() - dozen.rowwise().minCoeff()).sum();
  }
  return size;
}

TEST(NearPoints, InPatchesAreTheSamePointsWithThoseNearEachOtherTogether) {
  const Eigen::Matrix3Xf near = NearestToFirst(testing::DoorCloud(5, 0), 250);
  const Eigen::Matrix3Xf patches = InPatches(near);
  const auto sorted = [](const Eigen::Matrix3Xf& points) {
    std::vector<std::array<float, 3>> list;
    for (const auto& point : points.colwise()) list.push_back({point[0], point[1], point[2]});
    std::ranges::sort(list);
    return list;
  };
  EXPECT_EQ(sorted(patches), sorted(near));
  EXPECT_LT(SizeOfDozens(patches), 0.7F * SizeOfDozens(near));
}

TEST(NearPoints, InPatchesNothingStandsInForWhatIsMissing) {
  const std::vector<float> xyz = {1, 2, 3, 1, 2.05F, 3, 1, 2, 3.02F};
  EXPECT_EQ(InPatches(NearestToFirst(xyz, 64)).cols(), 3);
  EXPECT_EQ(InPatches(NearestToFirst(xyz, 0)).cols(), 0);
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

TEST(NearPoints, TellTurnsOfTheHandApartAndNeitherTheDoorsPlaceNorItsTurn) {
  StageNormalisation normalisation;
  normalisation.view.frame = ViewFrame::kHand;
  normalisation.action.deviation.fill(1);
  normalisation.angle_gain_rad.deviation.fill(1);
  normalisation.view.near_points = 64;
  const StageNetworks networks = InitialNetworks(normalisation, false, 3, NetworkFamily::kGrasp);
  std::vector<float> cloud = testing::DoorCloud(5, 0);
  std::vector<Eigen::Matrix3d> turns;
  for (const double angle : {0.0, 0.7})
    turns.emplace_back(RotationAbout(Eigen::Vector3d::UnitX(), angle).linear());
  turns.emplace_back(turns[1] * Eigen::Vector3d(-1, -1, 1).asDiagonal());
  const std::vector<float> ratings = GraspRater(networks).Rate(cloud, turns);
  EXPECT_GT(std::abs(ratings[0] - ratings[1]), 1e-5);
  EXPECT_NEAR(ratings[1], ratings[2], 1e-6) << "the other finger first";

  const RigidTransform moved = RotationAbout({0.6, 0, 0.8}, 1.1);
  for (std::size_t i = 0; i < cloud.size(); i += 3) {
    Eigen::Map<Eigen::Vector3f> point(&cloud[i]);
    point = (moved.linear().cast<float>() * point).eval() + Eigen::Vector3f(1, -2, 0.5F);
  }
  for (Eigen::Matrix3d& turn : turns) turn = (moved.linear() * turn).eval();
  const std::vector<float> there = GraspRater(networks).Rate(cloud, turns);
  for (std::size_t i = 0; i < turns.size(); ++i) EXPECT_NEAR(there[i], ratings[i], 1e-4) << i;
}

}  // namespace
}  // namespace doorforge::internal
