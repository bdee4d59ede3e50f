// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/physics/scene_sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"

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

TEST(SceneSampling, TheHashThatCameWithTheDoorIsBelieved) {
  const auto door = std::make_shared<const DoorAsset>(MakePrimitiveDoor({}));
  Scene scene = SampleScene(IdentifiedDoor{door, "as it was read"}, 7, 3);
  EXPECT_EQ(scene.door_sha256, "as it was read");
  scene.door_sha256 = ContentHash(*door);
  EXPECT_EQ(SceneToJson(scene).dump(), SceneToJson(SampleScene(*door, 7, 3)).dump());
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

TEST(SceneSampling, TheHeightVariesAsFarAsAskedAndNothingElseDoes) {
  const DoorAsset door = MakePrimitiveDoor({});
  SceneConfig config;
  config.height_jitter_m = 0.25;
  double lowest = 1;
  double highest = -1;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Scene still = SampleScene(door, 1, i);
    Scene moved = SampleScene(door, 1, i, config);
    const Eigen::Vector3d shift =
        moved.world_from_door.translation() - still.world_from_door.translation();
    EXPECT_EQ(shift.head<2>().norm(), 0);
    lowest = std::min(lowest, shift.z());
    highest = std::max(highest, shift.z());
    moved.world_from_door = still.world_from_door;
    EXPECT_EQ(SceneToJson(moved).dump(), SceneToJson(still).dump());
  }
  EXPECT_NEAR(lowest, -0.25, 0.02);
  EXPECT_NEAR(highest, 0.25, 0.02);
  config.height_jitter_m = 0.6;
  EXPECT_THROW(SampleScene(door, 1, 0, config), Error);
}

TEST(SceneSampling, TheLimitsOfAnEpisodeAreSettingsThatAreWrittenWhereTheyWereSet) {
  const DoorAsset door = MakePrimitiveDoor({});
  SceneConfig config;
  EXPECT_FALSE(ToJson(config).contains("episode"));
  Assign(nlohmann::ordered_json::parse(R"({"episode": {"open_angle_rad": 0.5}})"), config,
         "config.scene");
  EXPECT_EQ(SampleScene(door, 1, 0, config).limits.open_angle_rad, 0.5);
  EXPECT_EQ(ToJson(config).at("episode").at("open_angle_rad"), 0.5);
  SceneConfig again;
  Assign(ToJson(config), again, "config.scene");
  EXPECT_EQ(again.episode, config.episode);
  config.episode.slip_m = -1;
  try {
    SampleScene(door, 1, 0, config);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find("config.scene.episode.slip_m: found -1"), 0U)
        << error.what();
  }
}

SceneConfig With(Randomisation randomisation) {
  SceneConfig config;
  config.randomisation = randomisation;
  return config;
}

TEST(SceneSampling, WithoutRandomisationAllEpisodesOfADoorAreTheSame) {
  const DoorAsset door = MakePrimitiveDoor({});
  Scene first = SampleScene(door, 1, 0, With(Randomisation::kOff));
  Scene other = SampleScene(door, 2, 9, With(Randomisation::kOff));
  other.seed = first.seed;
  other.episode = first.episode;
  EXPECT_EQ(SceneToJson(first).dump(), SceneToJson(other).dump());
  EXPECT_EQ(first.variation, DoorVariation{});
}

TEST(SceneSampling, StrongRandomisationVariesTheDoorWithinItsRangesAndKeepsThePapersDraws) {
  const DoorAsset door = MakePrimitiveDoor({});
  const Latch made = door.latch;
  double least_mass = 9;
  double most_mass = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Scene paper = SampleScene(door, 1, i);
    const Scene strong = SampleScene(door, 1, i, With(Randomisation::kStrong));
    EXPECT_TRUE(strong.world_from_robot_base.isApprox(paper.world_from_robot_base));
    EXPECT_TRUE(strong.grasp_from_noisy_grasp.isApprox(paper.grasp_from_noisy_grasp));
    EXPECT_GE(strong.latch.hinge_spring_nm_per_rad, 0.58 * made.hinge_spring_nm_per_rad);
    EXPECT_LE(strong.latch.hinge_spring_nm_per_rad, 1.33 * made.hinge_spring_nm_per_rad);
    EXPECT_GE(strong.latch.unlock_angle_rad, 0.77 * made.unlock_angle_rad);
    EXPECT_LE(strong.latch.unlock_angle_rad, made.handle_done_angle_rad);
    EXPECT_GE(strong.physics.handle_friction, paper.physics.handle_friction);
    EXPECT_LE((strong.camera.position_m - paper.camera.position_m).cwiseAbs().maxCoeff(), 0.05);
    for (const double offset : strong.arm_start_offset_rad) EXPECT_LE(std::abs(offset), 0.05);
    least_mass = std::min(least_mass, strong.variation.leaf_mass);
    most_mass = std::max(most_mass, strong.variation.leaf_mass);
    const Scene again = SceneFromJson(SceneToJson(strong), "scene");
    EXPECT_EQ(again.variation, strong.variation);
    EXPECT_EQ(again.arm_start_offset_rad, strong.arm_start_offset_rad);
  }
  EXPECT_GE(least_mass, 0.7);
  EXPECT_LT(least_mass, 0.73);
  EXPECT_GT(most_mass, 1.27);
  EXPECT_LE(most_mass, 1.3);
}

TEST(SceneSampling, AVariedDoorHasItsFactors) {
  const DoorAsset door = MakePrimitiveDoor({});
  const DoorAsset varied = ApplyVariation(door, {.leaf_mass = 2, .handle_damping = 0.5});
  EXPECT_EQ(varied.links[kLeafLink].mass.mass_kg, 2 * door.links[kLeafLink].mass.mass_kg);
  EXPECT_TRUE(varied.links[kLeafLink].mass.inertia_kg_m2.isApprox(
      2 * door.links[kLeafLink].mass.inertia_kg_m2));
  EXPECT_EQ(varied.links[kHandleLink].mass.mass_kg, door.links[kHandleLink].mass.mass_kg);
  EXPECT_EQ(varied.handle_joint.damping_nm_s, 0.5 * door.handle_joint.damping_nm_s);
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

TEST(SceneSampling, ADoorHingedRightStandsAsTheMirrorImage) {
  for (const Category category : {Category::kInterior, Category::kCar}) {
    DoorAsset left = MakePrimitiveDoor({});
    DoorAsset right = MakePrimitiveDoor({.hinge_side = HingeSide::kRight});
    left.category = right.category = category;
    const SceneConfig still = With(Randomisation::kOff);
    const Scene a = SampleScene(left, 1, 0, still);
    const Scene b = SampleScene(right, 1, 0, still);
    const Eigen::Vector3d mirror(1, -1, 1);
    EXPECT_TRUE(GraspInWorld(b, right).isApprox(mirror.cwiseProduct(GraspInWorld(a, left)), 1e-9));
    EXPECT_TRUE(b.world_from_robot_base.translation().isApprox(
        mirror.cwiseProduct(a.world_from_robot_base.translation())));
  }
}

TEST(SceneSampling, WhoPushesLeansAwayFromTheJamb) {
  for (const HingeSide side : {HingeSide::kLeft, HingeSide::kRight}) {
    const DoorAsset door = MakePrimitiveDoor({.hinge_side = side, .opening = Opening::kPush});
    const Scene scene = SampleScene(door, 1, 0, With(Randomisation::kOff));
    const RigidTransform grasp = scene.world_from_door * DoorFromLinks(door, 0, 0)[kHandleLink] *
                                 door.handle_from_grasp * scene.grasp_from_noisy_grasp;
    // the robot is in front of the handle, the hand behind the grasp nearer to the hinge
    EXPECT_GT(scene.world_from_robot_base.translation().x(), grasp.translation().x());
    const double to_hinge = side == HingeSide::kLeft ? -1 : 1;
    EXPECT_NEAR(-grasp.linear()(1, 2) * to_hinge, std::sin(0.35), 1e-9);
    EXPECT_NEAR(grasp.linear()(0, 2), -std::cos(0.35), 1e-9);
  }
}

TEST(SceneSampling, WhoPushesAtAnUprightHandleLeansAwayFromTheJambAsWell) {
  for (const HingeSide side : {HingeSide::kLeft, HingeSide::kRight}) {
    for (const double turn : {std::numbers::pi / 2, -std::numbers::pi / 2}) {
      DoorAsset door = MakePrimitiveDoor({.hinge_side = side, .opening = Opening::kPush});
      // the lever's free end up, or down, as that of a window's
      door.handle_from_grasp =
          RotationAbout(Eigen::Vector3d::UnitX(), turn) * door.handle_from_grasp;
      const Scene scene = SampleScene(door, 1, 0, With(Randomisation::kOff));
      const RigidTransform grasp = scene.world_from_door * DoorFromLinks(door, 0, 0)[kHandleLink] *
                                   door.handle_from_grasp * scene.grasp_from_noisy_grasp;
      const double to_hinge = side == HingeSide::kLeft ? -1 : 1;
      EXPECT_NEAR(-grasp.linear()(1, 2) * to_hinge, std::sin(0.9), 1e-9);
      EXPECT_NEAR(grasp.linear()(2, 2), 0, 1e-9);            // level
      EXPECT_NEAR(std::abs(grasp.linear()(2, 0)), 1, 1e-9);  // along the handle
    }
  }
}

TEST(SceneSampling, TheCameraIsTheConfigs) {
  const DoorAsset door = MakePrimitiveDoor({});
  const CameraModel paper = SampleScene(door, 1, 0).camera;
  EXPECT_TRUE(paper.position_m.isApprox(CameraModel().position_m));
  EXPECT_TRUE(paper.target_m.isApprox(CameraModel().target_m));
  SceneConfig config;
  config.camera = {{1, -0.5, 1.2}, {0, 0.2, 1}, 640, 480, 1.2};
  const CameraModel own = SampleScene(door, 1, 0, config).camera;
  EXPECT_EQ(own.position_m, Eigen::Vector3d(1, -0.5, 1.2));
  EXPECT_EQ(own.target_m, Eigen::Vector3d(0, 0.2, 1));
  EXPECT_EQ(own.width, 640);
  EXPECT_EQ(own.height, 480);
  EXPECT_EQ(own.horizontal_fov_rad, 1.2);
}

TEST(SceneSampling, ACameraThatCannotBeIsRefused) {
  const CameraConfig faulty[] = {{.position_m = {1, 2}},
                                 {.target_m = {}},
                                 {.position_m = {1, 0, 2}, .target_m = {1, 0, 1}},
                                 {.width = 0},
                                 {.horizontal_fov_rad = 3.2}};
  for (const CameraConfig& config : faulty) {
    try {
      CameraOf(config);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidConfig);
      EXPECT_NE(std::string(error.what()).find("scene.camera."), std::string::npos);
    }
  }
}

TEST(SceneSampling, ADoorThatWouldBePushedFromWithinACupboardIsRefused) {
  DoorAsset door = MakePrimitiveDoor({.opening = Opening::kPush});
  EXPECT_NO_THROW(SampleScene(door, 1, 0));
  DoorGeometry back;
  back.name = "back";
  back.mesh = BoxMesh({0.45, -0.1, 0}, {0.47, 0.9, 1.9});
  back.hulls = {back.mesh};
  door.links[kBaseLink].geometry.push_back(back);
  try {
    SampleScene(door, 1, 0);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("\"back\""), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace doorforge
