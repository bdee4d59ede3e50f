// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/mirror.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "doorforge/core/rng.h"

namespace doorforge {
namespace {

const Eigen::Matrix3d kMirror = Eigen::Vector3d(1, -1, 1).asDiagonal();

Proprioception AnyProprioception(Rng& rng) {
  Proprioception proprioception{};
  for (float& number : proprioception) number = static_cast<float>(rng.Normal());
  Eigen::Quaterniond turn(rng.Normal(), rng.Normal(), rng.Normal(), rng.Normal());
  turn.normalize();
  for (Eigen::Index i = 0; i < 4; ++i)
    proprioception[28 + static_cast<std::size_t>(i)] = static_cast<float>(turn.coeffs()[i]);
  return proprioception;
}

// What the mirror makes of the hand's own axes, its fingers then exchanged.
Eigen::Matrix3d MirroredHand(const Eigen::Matrix3d& world_from_hand) {
  Eigen::Matrix3d mirrored = kMirror * world_from_hand;
  mirrored.col(1) *= -1;
  return mirrored;
}

TEST(Mirror, AHandInTheMirrorIsAHandWithItsFingersExchanged) {
  Rng rng(1, "test/mirror");
  for (int i = 0; i < 50; ++i) {
    const Proprioception before = AnyProprioception(rng);
    const Proprioception after = MirroredSideways(before);
    EXPECT_LT((HandRotationOf(after) - MirroredHand(HandRotationOf(before))).norm(), 1e-6);
    EXPECT_EQ(HandPositionOf(after), (kMirror.cast<float>() * HandPositionOf(before)).eval());
    EXPECT_EQ(BasePositionOf(after), (kMirror.cast<float>() * BasePositionOf(before)).eval());
    EXPECT_EQ(FingerOpeningsOf(after), FingerOpeningsOf(before).reverse().eval());
    EXPECT_EQ(MirroredSideways(after), before);
  }
}

TEST(Mirror, AnActionInTheMirrorLeadsToTheMirrorImageOfWhereItLed) {
  Rng rng(2, "test/mirror");
  for (int i = 0; i < 50; ++i) {
    const Proprioception now = AnyProprioception(rng);
    const Eigen::Matrix3d target = HandRotationOf(AnyProprioception(rng));
    const ActionVector action = ToVector({{rng.Normal(), rng.Normal(), rng.Normal()}, target});
    const Action mirrored = FromVector(MirroredSideways(action));
    EXPECT_LT((mirrored.world_from_hand_rotation - MirroredHand(target)).norm(), 1e-5);
    const Eigen::Vector3d way = kMirror * FromVector(action).position_delta_m;
    EXPECT_EQ(mirrored.position_delta_m, way);
    // a turn from the present rotation is mirrored alike
    const Eigen::Matrix3d turn = target * HandRotationOf(now).transpose();
    const Eigen::Matrix3d turned =
        FromVector(MirroredSideways(ToVector({{0, 0, 0}, turn}))).world_from_hand_rotation *
        HandRotationOf(MirroredSideways(now));
    EXPECT_LT((turned - MirroredHand(target)).norm(), 1e-5);
    EXPECT_EQ(MirroredSideways(MirroredSideways(action)), action);
  }
}

TEST(Mirror, ALevelMirrorDoesTheSameUpsideDown) {
  const Eigen::Matrix3d level = Eigen::Vector3d(1, 1, -1).asDiagonal();
  const auto hand_in = [&](const Eigen::Matrix3d& world_from_hand) {
    Eigen::Matrix3d mirrored = level * world_from_hand;
    mirrored.col(1) *= -1;
    return mirrored;
  };
  Rng rng(3, "test/mirror");
  for (int i = 0; i < 50; ++i) {
    const Proprioception before = AnyProprioception(rng);
    const Proprioception after = MirroredUpright(before);
    EXPECT_LT((HandRotationOf(after) - hand_in(HandRotationOf(before))).norm(), 1e-6);
    EXPECT_EQ(HandPositionOf(after), (level.cast<float>() * HandPositionOf(before)).eval());
    EXPECT_EQ(BasePositionOf(after), (level.cast<float>() * BasePositionOf(before)).eval());
    EXPECT_EQ(FingerOpeningsOf(after), FingerOpeningsOf(before).reverse().eval());
    EXPECT_EQ(MirroredUpright(after), before);
    const Eigen::Matrix3d target = HandRotationOf(AnyProprioception(rng));
    const ActionVector action = ToVector({{rng.Normal(), rng.Normal(), rng.Normal()}, target});
    const Action mirrored = FromVector(MirroredUpright(action));
    EXPECT_LT((mirrored.world_from_hand_rotation - hand_in(target)).norm(), 1e-5);
    const Eigen::Vector3d way = level * FromVector(action).position_delta_m;
    EXPECT_EQ(mirrored.position_delta_m, way);
    EXPECT_EQ(MirroredUpright(MirroredUpright(action)), action);
  }
  EXPECT_EQ(MirroredUpright(LabelledCloud{{1, 2, 3, 4, -5, 6}, {0, 1}}).xyz,
            (std::vector<float>{1, 2, -3, 4, -5, -6}));
}

TEST(Mirror, APointInTheMirrorHasTheOppositeY) {
  const LabelledCloud cloud{{1, 2, 3, 4, -5, 6}, {0, 1}};
  const LabelledCloud mirrored = MirroredSideways(cloud);
  EXPECT_EQ(mirrored.xyz, (std::vector<float>{1, -2, 3, 4, 5, 6}));
  EXPECT_EQ(mirrored.label, cloud.label);
}

}  // namespace
}  // namespace doorforge
