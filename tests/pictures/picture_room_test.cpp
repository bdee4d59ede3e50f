// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "picture_room.h"

#include <gtest/gtest.h>

#include "doorforge/core/rng.h"
#include "doorforge/physics/load_robot.h"
#include "doorforge/physics/scene_sampling.h"

#include "../physics/primitive_door.h"
#include "appearance.h"

namespace doorforge {
namespace {

struct RoomSetting {
  RobotModel robot = LoadMobileFranka();
  DoorAsset door = MakePrimitiveDoor({});
  Scene scene;
  PicturesConfig config;

  explicit RoomSetting(Category category) {
    door.category = category;
    scene = SampleScene(door, 1, 0);
  }
  PictureRoom Room() const { return PictureRoom({scene, door, robot, true, scene.camera}, config); }
};

Eigen::Vector3f AnyDirection(Rng& rng) {
  Eigen::Vector3d direction;
  for (double& component : direction) component = rng.Normal();
  return direction.normalized().cast<float>();
}

TEST(PictureRoom, EveryRayFromWithinMeetsItOnItsBoxOrInTheDoorsWall) {
  const RoomSetting setting(Category::kInterior);
  const PictureRoom room = setting.Room();
  const DoorWall wall = DoorWallOf(setting.scene, setting.door);
  Rng rng(3, "rays");
  int through = 0;
  int on_wall = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3f origin(wall.x + 1, 0.3F, 1.2F);
    const Eigen::Vector3f direction = AnyDirection(rng);
    const RoomHit hit = room.Meet(origin, direction);
    const Eigen::Vector3f at = origin + hit.distance * direction;
    EXPECT_LT(hit.normal.dot(direction), 0);
    EXPECT_LT(room.box().exteriorDistance(at), 1e-3F);
    const float from_box =
        std::min((at - room.box().min()).minCoeff(), (room.box().max() - at).minCoeff());
    if (std::fabs(at.x() - wall.x) < 1e-3F) {
      EXPECT_FALSE(wall.hole->contains(at.tail<2>()));
      EXPECT_EQ(hit.part, RoomPart::kDoorWall);
      EXPECT_TRUE(room.Blocks(origin, direction, hit.distance * 1.01F));
      EXPECT_FALSE(room.Blocks(origin, direction, hit.distance * 0.99F));
      ++on_wall;
    } else {
      EXPECT_LT(std::fabs(from_box), 1e-3F);
      through += at.x() < wall.x ? 1 : 0;
    }
  }
  EXPECT_GT(through, 20);
  EXPECT_GT(on_wall, 300);
}

// Frames may be arched: what is above the arch is wall.
TEST(PictureRoom, TheHoleIsOfTheFramesOutline) {
  const WallHole arch(
      {{-1, 0}, {1, 0}, {1, 1}, {0.7F, 1.7F}, {0, 2}, {-0.7F, 1.7F}, {-1, 1}, {0, 1}});
  for (const Eigen::Vector2f& inside : {Eigen::Vector2f(0, 1.9F), {0.95F, 0.5F}, {-0.7F, 1.65F}})
    EXPECT_TRUE(arch.contains(inside)) << inside.transpose();
  for (const Eigen::Vector2f& outside : {Eigen::Vector2f(0.95F, 1.95F),
                                         {-0.95F, 1.95F},
                                         {0.9F, 1.6F},
                                         {0, 2.01F},
                                         {1.01F, 0.5F},
                                         {0, -0.1F}})
    EXPECT_FALSE(arch.contains(outside)) << outside.transpose();
}

TEST(PictureRoom, HoldsTheRobotAndTheCamerasAndStandsASafeOnAPlinth) {
  RoomSetting setting(Category::kSafe);
  setting.scene.world_from_door.translation().z() += 0.5;
  PictureCamera far;
  far.name = "far";
  far.position_m = {6, -4, 3.5};
  setting.config.cameras = {far};
  const PictureRoom room = setting.Room();
  EXPECT_TRUE(room.box().contains(Eigen::Vector3f(6, -4, 3.5F)));
  EXPECT_TRUE(room.box().contains(setting.scene.camera.position_m.cast<float>()));
  EXPECT_FALSE(room.IsBehindWall({-50, 0, 1}));
  // from the front, close over the floor, at the middle of the door
  const float low = room.box().min().z() + 0.2F;
  const RoomHit hit = room.Meet({1.5F, 0, low}, {-1, 0, 0});
  EXPECT_EQ(hit.part, RoomPart::kPlinth);
  EXPECT_EQ(hit.normal, Eigen::Vector3f(1, 0, 0));
}

// Whether any mesh is of wood in one of many draws.
bool IsEverOfWood(Category category) {
  RoomSetting setting(category);
  setting.scene.appearance = SceneAppearance::kFull;
  const PictureRoom room = setting.Room();
  const std::vector<VisibleMesh> meshes(4, {TriangleMesh{}, 0, PointLabel::kBody});
  for (setting.scene.episode = 0; setting.scene.episode < 60; ++setting.scene.episode) {
    const Appearance drawn = DrawAppearance(
        {setting.scene, setting.door, setting.robot, true, setting.scene.camera}, meshes, room);
    for (const Finish& finish : drawn.meshes) {
      if (finish.texture == Texture::kWood) return true;
    }
  }
  return false;
}

TEST(Appearance, NobodyMakesCarsAndSafesOfWood) {
  EXPECT_FALSE(IsEverOfWood(Category::kCar));
  EXPECT_FALSE(IsEverOfWood(Category::kSafe));
  EXPECT_TRUE(IsEverOfWood(Category::kInterior));
  EXPECT_TRUE(IsEverOfWood(Category::kRefrigerator));
}

}  // namespace
}  // namespace doorforge
