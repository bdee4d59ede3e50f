// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/sensor/scene_geometry.h"

#include <limits>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

#include "shapes.h"

namespace doorforge {
namespace {

TEST(SceneGeometry, CountsLinksUpToTheLargestIndex) {
  const SceneGeometry scene({{shapes::Wall(0, 1), 0}, {shapes::Wall(1, 1), 4}});
  EXPECT_EQ(scene.link_count(), 5);
  EXPECT_EQ(scene.isa(), DefaultRayIsa());
}

TEST(SceneGeometry, RefusesFewerPosesThanLinks) {
  SceneGeometry scene({{shapes::Wall(0, 1), 1}});
  const std::vector<RigidTransform> one(1, RigidTransform::Identity());
  EXPECT_THROW(scene.MoveLinks(one), Error);
}

TEST(SceneGeometry, RefusesAPoseThatIsNotFinite) {
  SceneGeometry scene({{shapes::Wall(0, 1), 0}});
  const std::vector<RigidTransform> bad = {
      Translation({0, std::numeric_limits<double>::quiet_NaN(), 0})};
  EXPECT_THROW(scene.MoveLinks(bad), Error);
}

TEST(SceneGeometry, RefusesMeshesThatEmbreeWouldReadOutOfBounds) {
  TriangleMesh outside = shapes::Wall(0, 1);
  outside.triangles.push_back({0, 1, 4});
  EXPECT_THROW(SceneGeometry({{outside, 0}}), Error);
  TriangleMesh infinite = shapes::Wall(0, 1);
  infinite.vertices[2].x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(SceneGeometry({{infinite, 0}}), Error);
  EXPECT_THROW(SceneGeometry({{shapes::Wall(0, 1), -1}}), Error);
}

TEST(SceneGeometry, AcceptsNoMeshesAndMeshesWithoutTriangles) {
  SceneGeometry nothing({});
  nothing.MoveLinks({});
  SceneGeometry empty({{TriangleMesh{}, 0}, {shapes::Wall(0, 1), 0}});
  const std::vector<RigidTransform> poses(1, RigidTransform::Identity());
  empty.MoveLinks(poses);
  EXPECT_EQ(empty.link_count(), 1);
}

}  // namespace
}  // namespace doorforge
