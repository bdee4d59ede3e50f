// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "grasp_augmentation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/rng.h"
#include "doorforge/policy/grasp_rating.h"
#include "doorforge/policy/orientation_sampling.h"

#include "door_cloud.h"

namespace doorforge::internal {
namespace {

const Eigen::Vector3d kStraightIn(-1, 0, 0);

TrainConfig Config(double roll_rad, bool mirror) {
  TrainConfig config;
  config.family = NetworkFamily::kGrasp;
  config.augment_roll_rad = roll_rad;
  config.augment_mirror = mirror;
  return config;
}

TEST(GraspAugmentation, TurnsAboutTheWayInAndMirrorsSidewaysAndNothingElse) {
  Rng rng(1, "test");
  int mirrored = 0;
  double most = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Matrix3d a = DrawAugmentation(Config(0.5, true), kStraightIn, rng);
    EXPECT_LT((a * a.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_LT((a * kStraightIn - kStraightIn).norm(), 1e-12) << "neither turns the door around";
    // what was up is still up but for the roll
    const double roll = std::acos(std::clamp((a * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0));
    EXPECT_LE(roll, 0.5 + 1e-12);
    most = std::max(most, roll);
    mirrored += a.determinant() < 0 ? 1 : 0;
  }
  EXPECT_GT(most, 0.45);
  EXPECT_GT(mirrored, 70);
  EXPECT_LT(mirrored, 130);
  EXPECT_TRUE(DrawAugmentation(Config(0, false), kStraightIn, rng).isIdentity(0));
  EXPECT_GT(DrawAugmentation(Config(0.5, false), kStraightIn, rng).determinant(), 0);
}

TEST(GraspAugmentation, AGeometryIsThatOfTheAugmentedCloud) {
  std::vector<float> cloud = testing::DoorCloud(5, 0);
  // a mirror and a quarter turn: not a bit of a coordinate is rounded
  Eigen::Matrix3d augmentation;
  augmentation << 1, 0, 0, 0, 0, 1, 0, 1, 0;
  ASSERT_LT(augmentation.determinant(), 0);
  const auto augmented = Augmented(
      std::make_shared<const CloudGeometry>(BuildGeometry(cloud, {{}, 0.6F, 4})), augmentation);
  for (std::size_t i = 0; i < cloud.size(); i += 3) std::swap(cloud[i + 1], cloud[i + 2]);
  const CloudGeometry expected = BuildGeometry(cloud, {{}, 0.6F, 4});
  EXPECT_EQ(augmented->xyz, expected.xyz);
  for (std::size_t level = 0; level < 4; ++level) {
    EXPECT_EQ(augmented->levels[level].centre_xyz, expected.levels[level].centre_xyz);
    EXPECT_EQ(augmented->levels[level].member, expected.levels[level].member);
    EXPECT_EQ(augmented->upsampling[level].neighbour, expected.upsampling[level].neighbour);
  }
}

TEST(GraspAugmentation, AHandStaysAHandThatHoldsTheSame) {
  Rng rng(2, "test");
  const Eigen::Matrix3d hand = SampleOrientations(kStraightIn, {1, 0.1}, rng).front();
  const Eigen::Vector3d contact(0.1, -0.2, 0.3);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Matrix3d a = DrawAugmentation(Config(0.5, true), kStraightIn, rng);
    const Action shown = FromVector(Augmented(ToVector({contact, hand}), a));
    const Eigen::Matrix3d& rotation = shown.world_from_hand_rotation;
    EXPECT_NEAR(rotation.determinant(), 1, 1e-5);
    EXPECT_LT((shown.position_delta_m - a * contact).norm(), 1e-6);
    // the way in and the plane of the fingers go along; the two fingers may change places
    EXPECT_LT((rotation.col(2) - a * hand.col(2)).norm(), 1e-5);
    EXPECT_NEAR(std::abs(rotation.col(1).dot(a * hand.col(1))), 1, 1e-5);
  }
}

TEST(SmoothedRatings, AreMeansOfWhatIsTurnedAlikeWithEitherFingerFirst) {
  const auto about_z = [](double angle) -> Eigen::Matrix3d {
    return RotationAbout(Eigen::Vector3d::UnitZ(), angle).linear();
  };
  const Eigen::Vector3d at(1, 2, 3);
  const std::vector<RatedHand> hands = {{at, about_z(0), 4},
                                        {at, about_z(0.1), 1},
                                        {at, about_z(std::numbers::pi), 1},
                                        {at, about_z(std::numbers::pi / 2), 0}};
  EXPECT_EQ(Smoothed(hands, 0, 0), (std::vector<double>{2.5, 1, 2.5, 0})) << "half a turn alone";
  const std::vector<double> smoothed = Smoothed(hands, 0.2, 0);
  const double near = std::exp(-0.25);
  EXPECT_NEAR(smoothed[0], (4 + near * 1 + 1) / (2 + near), 1e-4);
  EXPECT_NEAR(smoothed[2], smoothed[0], 1e-4) << "half a turn is the same grasp";
  EXPECT_NEAR(smoothed[1], (1 + near * 5) / (1 + 2 * near), 1e-4);
  EXPECT_NEAR(smoothed[3], 0, 1e-6);
}

TEST(SmoothedRatings, AreMeansOfWhatTouchesNearby) {
  const Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  const std::vector<RatedHand> hands = {
      {{0, 0, 0}, turn, 4}, {{0.01, 0, 0}, turn, 1}, {{0, 1, 0}, turn, 7}};
  EXPECT_EQ(Smoothed(hands, 0.2, 0), (std::vector<double>{4, 1, 7})) << "other points do not count";
  const std::vector<double> smoothed = Smoothed(hands, 0.2, 0.02);
  const double near = std::exp(-0.25);
  EXPECT_NEAR(smoothed[0], (4 + near * 1) / (1 + near), 1e-6);
  EXPECT_NEAR(smoothed[1], (1 + near * 4) / (1 + near), 1e-6);
  EXPECT_NEAR(smoothed[2], 7, 1e-6);
}

// This follows the header word by word, over all pairs.
double PlainlySmoothed(const std::vector<RatedHand>& hands, std::size_t i, double width_rad,
                       double width_m) {
  const auto angle = [](const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
    return Eigen::AngleAxisd(a.transpose() * b).angle();
  };
  const Eigen::Matrix3d other_finger =
      RotationAbout(Eigen::Vector3d::UnitZ(), std::numbers::pi).linear();
  double sum = 0;
  double weights = 0;
  for (const RatedHand& hand : hands) {
    const double turn = std::min(
        angle(hands[i].world_from_hand_rotation, hand.world_from_hand_rotation),
        angle(hands[i].world_from_hand_rotation, hand.world_from_hand_rotation * other_finger));
    const double away = (hands[i].contact_m - hand.contact_m).norm();
    const double weight = std::exp(-std::pow(turn / width_rad, 2) - std::pow(away / width_m, 2));
    sum += weight * hand.rating_rad;
    weights += weight;
  }
  return sum / weights;
}

TEST(SmoothedRatings, AreThePlainMeansOfManyHands) {
  Rng rng(5, "hands");
  std::vector<RatedHand> hands;
  for (int i = 0; i < 120; ++i) {
    const Eigen::Vector3d axis(rng.Normal(), rng.Normal(), rng.Normal());
    hands.push_back({Eigen::Vector3d(rng.Normal(), rng.Normal(), rng.Normal()) * 0.01,
                     RotationAbout(axis.normalized(), rng.Uniform(0, 3)).linear(),
                     rng.Uniform(0, 1)});
  }
  for (const auto& [width_rad, width_m] : {std::pair{0.25, 0.01}, {0.6, 0.03}, {2.0, 1.0}}) {
    const std::vector<double> smoothed = Smoothed(hands, width_rad, width_m);
    for (std::size_t i = 0; i < hands.size(); ++i)
      EXPECT_NEAR(smoothed[i], PlainlySmoothed(hands, i, width_rad, width_m), 1e-7);
  }
}

}  // namespace
}  // namespace doorforge::internal
