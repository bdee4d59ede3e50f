// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/ray_packet.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "shapes.h"

namespace doorforge {
namespace {

// Boxes of side 2 about (0, 0, 0), as it was made, and about (5, 0, 0), where its link is.
SceneGeometry TwoBoxes() {
  const TriangleMesh box = shapes::Box({-1, -1, -1}, {1, 1, 1});
  SceneGeometry scene({{box, 0, PointLabel::kBody}, {box, 1, PointLabel::kHandle}});
  const RigidTransform poses[] = {
      RigidTransform::Identity(),
      Translation({5, 0, 0}) * RotationAbout(Eigen::Vector3d::UnitZ(), 0.1)};
  scene.MoveLinks(poses);
  return scene;
}

TEST(RayPacket, RaysMeetTheFirstBoxOnTheirWayAndThoseThatAreNotThereNone) {
  SceneGeometry scene = TwoBoxes();
  RayPacket packet;
  packet.Set(0, {-3, 0.2F, 0.1F}, {1, 0, 0}, 100);
  packet.Set(3, {3, 0.2F, 0.1F}, {0.5F, 0, 0}, 100);
  packet.Set(7, {-3, 0.2F, 0.1F}, {1, 0, 0}, 1.9F);  // ends before it
  packet.Set(15, {-3, 4, 0}, {1, 0, 0}, 100);        // beside both
  const PacketHits hits = CastRays(scene, packet);
  EXPECT_EQ(hits.hits, 1U << 0 | 1U << 3);
  EXPECT_EQ(hits.mesh[0], 0);
  EXPECT_NEAR(hits.distance[0], 2, 1e-5);
  EXPECT_EQ(hits.mesh[3], 1);
  // the side x = -1 of a box that is turned by 0.1 about (5, 0)
  const double x = 5 + (-1 - 0.2 * std::sin(0.1)) / std::cos(0.1);
  EXPECT_NEAR(hits.distance[3], (x - 3) / 0.5, 1e-4);
  EXPECT_EQ(ObstructedRays(scene, packet), hits.hits);
}

TEST(RayPacket, BoundsHoldEverythingWhereItStands) {
  SceneGeometry scene = TwoBoxes();
  const double reach = std::cos(0.1) + std::sin(0.1);  // half the width of the box that is turned
  const Eigen::AlignedBox3f bounds = BoundsOf(scene);
  EXPECT_LT((bounds.min().cast<double>() - Eigen::Vector3d(-1, -reach, -1)).norm(), 1e-4);
  EXPECT_LT((bounds.max().cast<double>() - Eigen::Vector3d(5 + reach, reach, 1)).norm(), 1e-4);
  SceneGeometry nothing({});
  nothing.MoveLinks({});
  EXPECT_TRUE(BoundsOf(nothing).isEmpty());
}

TEST(RayPacket, NormalsOfABoxAreThoseOfItsFaces) {
  SceneGeometry scene = TwoBoxes();
  RayPacket packet;
  packet.Set(0, {-3, 0.2F, 0.1F}, {1, 0, 0}, 100);
  const PacketHits hits = CastRays(scene, packet);
  const Eigen::Vector3f normal = scene.SmoothNormal(0, hits.triangle[0], hits.u[0], hits.v[0]);
  EXPECT_LT((normal - Eigen::Vector3f(-1, 0, 0)).norm(), 1e-6F);
}

}  // namespace
}  // namespace doorforge
