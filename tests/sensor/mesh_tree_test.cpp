// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh_tree.h"

#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "doorforge/sensor/depth_camera.h"

#include "shapes.h"

namespace doorforge::internal {
namespace {

// A wall that no other test has.
TriangleMesh WallAt(double x) { return shapes::Wall(x, 1); }

TriangleMesh Fine(std::size_t triangles, double x) {
  TriangleMesh mesh = WallAt(x);
  mesh.triangles.resize(triangles, mesh.triangles[0]);
  return mesh;
}

TEST(MeshTrees, EqualMeshesShareATreeAndOthersDoNot) {
  MeshTrees trees(DefaultRayIsa());
  const auto tree = trees.TreeOf(WallAt(1));
  const auto other = trees.TreeOf(WallAt(2));
  EXPECT_NE(other, tree);
  EXPECT_EQ(trees.TreeOf(WallAt(1)), tree);
  EXPECT_EQ(trees.TreeOf(WallAt(2)), other);
  TriangleMesh turned = WallAt(1);
  std::swap(turned.triangles[0].x(), turned.triangles[0].y());
  EXPECT_NE(trees.TreeOf(turned), tree) << "the same vertices, but other triangles";
  TriangleMesh open = WallAt(1);
  open.triangles.pop_back();
  EXPECT_NE(trees.TreeOf(open), tree);
}

TEST(MeshTrees, AMeshWithoutTrianglesHasNoTree) {
  EXPECT_EQ(MeshTrees(DefaultRayIsa()).TreeOf(TriangleMesh{})->tree(), nullptr);
}

TEST(MeshTrees, ThoseUsedLastAreKeptWhileTheyAreFewTriangles) {
  MeshTrees trees(DefaultRayIsa());
  constexpr std::size_t kThird = MeshTrees::kMostKeptTriangles / 3;
  std::vector<std::weak_ptr<const MeshTree>> made;
  for (int i = 0; i < 3; ++i) made.push_back(trees.TreeOf(Fine(kThird, i)));
  for (const auto& tree : made) EXPECT_FALSE(tree.expired());
  trees.TreeOf(Fine(kThird, 0));  // now used after the second
  trees.TreeOf(Fine(kThird, 3));
  EXPECT_FALSE(made[0].expired());
  EXPECT_TRUE(made[1].expired());
  EXPECT_FALSE(made[2].expired());
}

TEST(MeshTrees, ManySmallMeshesAreNotAllKept) {
  MeshTrees trees(DefaultRayIsa());
  const std::weak_ptr<const MeshTree> first = trees.TreeOf(WallAt(-1));
  for (std::size_t i = 1; i < MeshTrees::kMostKept; ++i)
    trees.TreeOf(WallAt(static_cast<double>(i)));
  EXPECT_FALSE(first.expired());
  trees.TreeOf(WallAt(-2));
  EXPECT_TRUE(first.expired());
}

TEST(MeshTrees, ATreeLargerThanAllThatIsKeptIsGivenNevertheless) {
  MeshTrees trees(DefaultRayIsa());
  const TriangleMesh mesh = Fine(MeshTrees::kMostKeptTriangles + 1, 0);
  EXPECT_TRUE(trees.TreeOf(mesh)->IsOf(mesh));
}

// What a thread keeps goes with it; a scene that it handed on must not.
TEST(MeshTrees, ASceneOutlivesTheThreadThatMadeIt) {
  CameraModel camera;
  camera.width = camera.height = 16;
  const std::vector<RigidTransform> still(1, RigidTransform::Identity());
  const std::vector<VisibleMesh> meshes = {{shapes::Wall(0.5, 3), 0}};
  const DepthImage here = DepthCamera(meshes).Render(camera, still);
  std::unique_ptr<DepthCamera> handed_on;
  std::thread([&] { handed_on = std::make_unique<DepthCamera>(meshes); }).join();
  EXPECT_EQ(handed_on->Render(camera, still).depth_m, here.depth_m);
}

}  // namespace
}  // namespace doorforge::internal
