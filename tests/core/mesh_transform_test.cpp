// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/core/mesh_transform.h"

#include <array>
#include <numbers>

#include <gtest/gtest.h>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/mass_properties.h"

#include "box_mesh.h"

namespace doorforge {
namespace {

TEST(MeshTransform, AQuarterTurnMovesTheBoxAsOnPaper) {
  const TriangleMesh box = BoxMesh({1, 2, 3}, {2, 4, 6});
  const RigidTransform pose =
      Translation({0.5, 0, -1}) * RotationAbout(Eigen::Vector3d::UnitZ(), std::numbers::pi / 2);
  const Eigen::AlignedBox3d moved = BoundsOf(Transformed(box, pose));
  // a quarter turn about z takes (x, y) to (-y, x)
  EXPECT_TRUE(moved.min().isApprox(Eigen::Vector3d(-3.5, 1, 2), 1e-12)) << moved.min();
  EXPECT_TRUE(moved.max().isApprox(Eigen::Vector3d(-1.5, 2, 5), 1e-12)) << moved.max();
}

TEST(MeshTransform, MergedMeshesKeepTheirVolumes) {
  const std::array meshes = {BoxMesh({0, 0, 0}, {1, 1, 1}), TriangleMesh{},
                             BoxMesh({2, 0, 0}, {3, 2, 1})};
  const TriangleMesh merged = Merged(meshes);
  ASSERT_EQ(merged.vertices.size(), 16U);
  ASSERT_EQ(merged.triangles.size(), 24U);
  const auto closed = ClosedMesh::From(merged);
  ASSERT_TRUE(closed.has_value());
  EXPECT_NEAR(MassPropertiesOf(*closed, 1).mass_kg, 1 + 2, 1e-12);
}

TEST(MeshTransform, NothingHasEmptyBounds) {
  EXPECT_TRUE(BoundsOf({}).isEmpty());
  EXPECT_TRUE(Merged({}).vertices.empty());
}

}  // namespace
}  // namespace doorforge
