// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/scene_sampling.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "primitive_door.h"

namespace doorforge {
namespace {

Eigen::Vector3d GraspInWorld(const Scene& scene, const DoorAsset& door) {
  return scene.world_from_door * DoorFromLinks(door, 0, 0)[kHandleLink] *
         door.handle_from_grasp.translation();
}

TEST(SceneSampling, EqualArgumentsGiveEqualScenesAndOthersDiffer) {
  const DoorAsset door = MakePrimitiveDoor({});
  const std::string scene = SceneToJson(SampleScene(door, 7, 3)).dump();
  EXPECT_EQ(SceneToJson(SampleScene(door, 7, 3)).dump(), scene);
  EXPECT_NE(SceneToJson(SampleScene(door, 8, 3)).dump(), scene);
  EXPECT_NE(SceneToJson(SampleScene(door, 7, 4)).dump(), scene);
}

TEST(SceneSampling, TheGraspPointLiesWhereUniDoorManipHasIt) {
  for (const Category category : {Category::kInterior, Category::kStorageFurniture}) {
    for (std::uint64_t i = 0; i < 20; ++i) {
      DoorAsset door = MakePrimitiveDoor(RandomPrimitive(Mechanism::kLever, 1, i));
      door.category = category;
      const Scene scene = SampleScene(door, 1, i);
      const Eigen::Vector3d grasp = GraspInWorld(scene, door);
      EXPECT_GE(scene.world_from_door.translation().z(), 0.1);
      EXPECT_GT(grasp.z(), category == Category::kInterior ? 0.899 : 0.739);
      EXPECT_GT(grasp.x(), 0.029);
      EXPECT_LT(grasp.x(), 0.121);
    }
  }
}

TEST(SceneSampling, ADoorThatIsInTheRangeIsOnlyLiftedATenthOfAMetre) {
  PrimitiveDoor shape;
  shape.handle_height_m = 0.85;
  shape.width_m = 0.06 + 0.30 + shape.grasp_fraction * shape.length_m;
  const DoorAsset door = MakePrimitiveDoor(shape);
  const Scene scene = SampleScene(door, 1, 0);
  EXPECT_LT((scene.world_from_door.translation() - Eigen::Vector3d(0, 0, 0.1)).norm(), 1e-12);
}

TEST(SceneSampling, JitterAndNoiseStayInTheirBoundsAndCanBeSwitchedOff) {
  const DoorAsset door = MakePrimitiveDoor({});
  double spread = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Scene scene = SampleScene(door, 1, i);
    const Eigen::Vector3d base = scene.world_from_robot_base.translation();
    EXPECT_LE(std::abs(base.x() - 0.7), 0.1 + 1e-12);
    EXPECT_LE(std::abs(base.y()), 0.15 + 1e-12);
    const Eigen::Vector3d turn = RotationVector(scene.grasp_from_noisy_grasp.linear());
    EXPECT_LE(turn.norm(), 0.1746);
    spread += turn.norm() / 200;
  }
  EXPECT_GT(spread, 0.03);
  SceneConfig still;
  still.base_jitter = 0;
  still.grasp_noise = 0;
  const Scene scene = SampleScene(door, 1, 5, still);
  EXPECT_TRUE(scene.grasp_from_noisy_grasp.isApprox(RigidTransform::Identity(), 0));
  EXPECT_DOUBLE_EQ(scene.world_from_robot_base.translation().x(), 0.7);
}

}  // namespace
}  // namespace doorforge
