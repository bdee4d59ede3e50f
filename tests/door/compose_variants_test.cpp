// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/compose/compose.h"
#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/config_io.h"
#include "doorforge/core/error.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/schemas/motion_way.h"
#include "doorforge/validate/validate_door.h"

#include "mujoco_door.h"
#include "scratch_folder.h"
#include "small_parts.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

Eigen::AlignedBox3d BoxOfLink(const DoorAsset& door, DoorLinkIndex link, double hinge_rad) {
  Eigen::AlignedBox3d box;
  const RigidTransform place = DoorFromLinks(door, hinge_rad, 0)[link];
  for (const DoorGeometry& geometry : door.links[link].geometry) {
    for (const Eigen::Vector3d& vertex : geometry.mesh.vertices) box.extend(place * vertex);
  }
  return box;
}

// of a closed mesh and its mass, by an independent integral
void ExpectMassesOfTheMeshes(const DoorAsset& door) {
  for (const DoorLink& link : door.links) {
    ASSERT_EQ(link.geometry.size(), 1U);
    const auto closed = ClosedMesh::From(link.geometry[0].mesh);
    ASSERT_TRUE(closed) << link.name << " is not closed with positive volume";
    const MassProperties unit = MassPropertiesOf(*closed, 1);
    const MassProperties expected = MassPropertiesOf(*closed, link.mass.mass_kg / unit.mass_kg);
    EXPECT_LT((link.mass.center_of_mass_m - expected.center_of_mass_m).norm(), 1e-6) << link.name;
    if (link.name == "handle") continue;  // its inertia has a floor
    EXPECT_TRUE(link.mass.inertia_kg_m2.isApprox(expected.inertia_kg_m2, 1e-5)) << link.name;
  }
}

std::string Refusal(const Part& body, const Part& handle, const ComposeConfig& config) {
  try {
    ComposeDoor(body, handle, config);
    return "accepted";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(ComposeVariants, ARightHingedDoorIsTheMirrorImageOfTheLeftOne) {
  const DoorAsset left = ComposeDoor(SmallBody(), SmallLever(), {});
  const DoorAsset right = ComposeDoor(SmallBody(), SmallLever(), {.hinge_side = HingeSide::kRight});
  EXPECT_EQ(right.hinge_side, HingeSide::kRight);
  for (const Stage stage : {Stage::kOpen, Stage::kHandle, Stage::kGrasp}) {
    EXPECT_EQ(WayOf(left, stage), MotionWay::kUsual);
    EXPECT_EQ(WayOf(right, stage), MotionWay::kUsual);
  }
  EXPECT_EQ(right.id, "small_body__small_lever__right");
  EXPECT_EQ(right.body.sha256, left.body.sha256);
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1, -1, 1).asDiagonal();
  for (const double hinge : {0.0, 0.7}) {
    for (const double handle : {0.0, 0.5}) {
      const auto a = DoorFromLinks(left, hinge, handle);
      const auto b = DoorFromLinks(right, hinge, handle);
      for (std::size_t link = 0; link < 3; ++link) {
        const auto& mesh_a = left.links[link].geometry[0].mesh;
        const auto& mesh_b = right.links[link].geometry[0].mesh;
        for (std::size_t i = 0; i < mesh_a.vertices.size(); ++i)
          EXPECT_LT((mirror * (a[link] * mesh_a.vertices[i]) - b[link] * mesh_b.vertices[i]).norm(),
                    1e-6);
      }
      EXPECT_LT((mirror * (a[2] * left.handle_from_grasp.translation()) -
                 b[2] * right.handle_from_grasp.translation())
                    .norm(),
                1e-6);
    }
  }
  EXPECT_NEAR(right.handle_from_grasp.linear().determinant(), 1, 1e-9);
  ExpectMassesOfTheMeshes(right);
}

TEST(ComposeVariants, APushedDoorGoesAwayFromItsHandle) {
  const DoorAsset door = ComposeDoor(SmallBody(), SmallLever(), {.opening = Opening::kPush});
  EXPECT_EQ(WayOf(door, Stage::kOpen), MotionWay::kOther);
  EXPECT_EQ(WayOf(door, Stage::kHandle), MotionWay::kUsual);
  const Eigen::AlignedBox3d shut = BoxOfLink(door, kLeafLink, 0);
  const Eigen::AlignedBox3d open = BoxOfLink(door, kLeafLink, 0.8);
  EXPECT_LT(open.min().x(), shut.min().x() - 0.3);
  EXPECT_GT(BoxOfLink(door, kHandleLink, 0).max().x(), shut.max().x() + 0.05);
  ExpectMassesOfTheMeshes(door);
  Part safe = SmallBody();
  Part knob = SmallLever();
  safe.category = knob.category = Category::kSafe;
  EXPECT_NE(Refusal(safe, knob, {.opening = Opening::kPush}).find("CMP006"), std::string::npos);
}

TEST(ComposeVariants, AMirroredLeverPointsTheOtherWayAndStillGoesDown) {
  const DoorAsset door =
      ComposeDoor(SmallBody(), SmallLever(), {.backset_m = 0.2, .handle_mirrored = true});
  const Eigen::Vector3d grasp = door.handle_from_grasp.translation();
  const auto shut = DoorFromLinks(door, 0, 0);
  const auto pressed = DoorFromLinks(door, 0, 0.5);
  EXPECT_EQ(WayOf(door, Stage::kHandle), MotionWay::kUsual);
  EXPECT_GT((shut[2] * grasp).y(), shut[2].translation().y() + 0.05);
  EXPECT_LT((pressed[2] * grasp).z(), (shut[2] * grasp).z() - 0.03);
  EXPECT_NE(Refusal(SmallBody(), SmallLever(), {.handle_mirrored = true}).find("CMP010"),
            std::string::npos);
}

TEST(ComposeVariants, AReversedLeverLooksTheSameAndGoesUp) {
  const DoorAsset made = ComposeDoor(SmallBody(), SmallLever(), {});
  const DoorAsset door =
      ComposeDoor(SmallBody(), SmallLever(), {.handle_sense = HandleSense::kReversed});
  EXPECT_EQ(door.id, "small_body__small_lever__reversed");
  EXPECT_EQ(WayOf(made, Stage::kHandle), MotionWay::kUsual);
  EXPECT_EQ(WayOf(door, Stage::kHandle), MotionWay::kOther);
  const Eigen::Vector3d grasp = door.handle_from_grasp.translation();
  const auto shut = DoorFromLinks(door, 0, 0);
  const auto lifted = DoorFromLinks(door, 0, 0.5);
  EXPECT_GT((lifted[2] * grasp).z(), (shut[2] * grasp).z() + 0.03);
  // the handle's frame and shape are those of the other door: it is the axis alone that is reversed
  for (std::size_t link = 0; link < 3; ++link) {
    EXPECT_TRUE(shut[link].isApprox(DoorFromLinks(made, 0, 0)[link], 0));
    EXPECT_EQ(door.links[link].geometry[0].mesh.vertices,
              made.links[link].geometry[0].mesh.vertices);
  }
  EXPECT_TRUE(DoorFromLinks(door, 0, 0.5)[2].isApprox(DoorFromLinks(made, 0, -0.5)[2], 1e-12));
  Part pull = SmallLever();
  pull.mechanism = Mechanism::kNone;
  EXPECT_NE(Refusal(SmallBody(), pull, {.handle_sense = HandleSense::kReversed}).find("CMP012"),
            std::string::npos);
}

TEST(ComposeVariants, AQuarterTurnMakesAnUprightBarOfALyingOne) {
  const DoorAsset door = ComposeDoor(SmallBody(), SmallLever(), {.handle_turn_deg = 90});
  const Eigen::Vector3d size = BoxOfLink(door, kHandleLink, 0).sizes();
  EXPECT_GT(size.z(), 0.15);
  EXPECT_LT(size.y(), 0.03);
  EXPECT_NEAR(size.x(), 0.06875, 1e-6);
}

TEST(ComposeVariants, ALeafIsStretchedToTheWantedSize) {
  const DoorAsset door =
      ComposeDoor(SmallBody(), SmallLever(), {.leaf_width_m = 1.0, .leaf_height_m = 2.0});
  const Eigen::AlignedBox3d leaf = BoxOfLink(door, kLeafLink, 0);
  EXPECT_NEAR(leaf.sizes().y(), 1.0, 1e-6);
  EXPECT_NEAR(leaf.sizes().z(), 2.0, 1e-6);
  EXPECT_NEAR(leaf.sizes().x(), 0.04, 1e-6);
  // 20 kg at 0.8 x 1.6 m
  EXPECT_NEAR(door.links[kLeafLink].mass.mass_kg, 20 * 1.25 * 1.25, 1e-6);
  ExpectMassesOfTheMeshes(door);
  // 0.08 m from the free edge before and after
  EXPECT_NEAR(leaf.max().y() - DoorFromLinks(door, 0, 0)[2].translation().y(), 0.08, 1e-6);
}

TEST(ComposeVariants, PresetsSetMassesAndJointsAndNameTheirSource) {
  const DoorAsset door = ComposeDoor(
      SmallBody(), SmallLever(), {.joints = JointPreset::kDoorGym, .masses = MassPreset::kDoorGym});
  EXPECT_NEAR(door.links[kLeafLink].mass.mass_kg, 300 * 0.8 * 1.6 * 0.04, 1e-6);
  EXPECT_NEAR(door.links[kHandleLink].mass.mass_kg, 1, 1e-9);
  EXPECT_DOUBLE_EQ(door.hinge.damping_nm_s, 1.5);
  EXPECT_DOUBLE_EQ(door.latch.handle_spring_nm_per_rad, 1.25);
  EXPECT_NE(door.physics_source.find("DoorGym"), std::string::npos);
  const DoorAsset set = ComposeDoor(
      SmallBody(), SmallLever(), {.joints = JointPreset::kUniDoorManip, .hinge_damping_nm_s = 0.7});
  EXPECT_DOUBLE_EQ(set.hinge.damping_nm_s, 0.7);
  EXPECT_DOUBLE_EQ(set.handle_joint.damping_nm_s, 0);
}

TEST(ComposeVariants, ALatchIsWhatTheConfigSays) {
  const DoorAsset bolt =
      ComposeDoor(SmallBody(), SmallLever(),
                  {.latch = LatchChoice::kBolt, .unlock_angle_rad = 0.4, .bolt_throw_m = 0.01});
  EXPECT_EQ(bolt.latch.type, LatchType::kBolt);
  EXPECT_DOUBLE_EQ(bolt.latch.unlock_angle_rad, 0.4);
  EXPECT_DOUBLE_EQ(bolt.latch.bolt_throw_m, 0.01);
  Part pull = SmallLever();
  pull.joint.upper_rad = 0;
  pull.mechanism = Mechanism::kNone;
  EXPECT_NE(Refusal(SmallBody(), pull, {.latch = LatchChoice::kBolt}).find("CMP007"),
            std::string::npos);
  EXPECT_NE(Refusal(SmallBody(), SmallLever(), {.unlock_angle_rad = 3}).find("unlock_angle_rad"),
            std::string::npos);
}

TEST(ComposeVariants, ASeedVariesTheDoorAndTheSameSeedDoesNot) {
  const DoorAsset plain = ComposeDoor(SmallBody(), SmallLever(), {});
  const DoorAsset a = ComposeDoor(SmallBody(), SmallLever(), {.seed = 7});
  const DoorAsset b = ComposeDoor(SmallBody(), SmallLever(), {.seed = 7});
  const DoorAsset c = ComposeDoor(SmallBody(), SmallLever(), {.seed = 8});
  EXPECT_EQ(ContentHash(a), ContentHash(b));
  const double width = BoxOfLink(a, kLeafLink, 0).sizes().y();
  EXPECT_NE(width, BoxOfLink(c, kLeafLink, 0).sizes().y());
  EXPECT_NE(width, BoxOfLink(plain, kLeafLink, 0).sizes().y());
  EXPECT_NEAR(width, 0.8, 0.0401);
  const DoorAsset set = ComposeDoor(SmallBody(), SmallLever(), {.leaf_width_m = 0.8, .seed = 7});
  EXPECT_NEAR(BoxOfLink(set, kLeafLink, 0).sizes().y(), 0.8, 1e-6);
}

TEST(ComposeVariants, RefusalsNameTheirRule) {
  Part other = SmallLever();
  other.category = Category::kSafe;
  EXPECT_NE(Refusal(SmallBody(), other, {}).find("CMP002"), std::string::npos);
  EXPECT_NE(Refusal(SmallLever(), SmallBody(), {}).find("CMP001"), std::string::npos);
  Part huge = SmallLever();
  huge.pieces[0] = MakeSolid("grip", BoxMesh({0, -1, -1}, {0.05, 1, 1}), 1);
  EXPECT_NE(Refusal(SmallBody(), huge, {}).find("CMP004"), std::string::npos);
  EXPECT_NE(Refusal(SmallBody(), SmallLever(), {.handle_height_m = 3}).find("CMP008"),
            std::string::npos);
  EXPECT_NE(Refusal(SmallBody(), SmallLever(), {.license_allow = {"MIT"}}).find("CMP009"),
            std::string::npos);
  ComposeConfig config;
  try {
    Assign(nlohmann::ordered_json{{"hinge_side", "rigth"}}, config, "config");
    ADD_FAILURE() << "taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"right\""), std::string::npos);
  }
}

TEST(ComposeVariants, ThePageListsEveryRuleAndPreset) {
  std::ifstream file(fs::path(DOORFORGE_SOURCE_DIR) / "docs/compose.md");
  std::stringstream page;
  page << file.rdbuf();
  for (const ComposeRule& rule : ComposeRules()) {
    EXPECT_NE(page.str().find(std::string(rule.code) + "` | " + std::string(rule.text)),
              std::string::npos)
        << rule.code;
  }
  for (const auto& presets : {JointPresets(), MassPresets()}) {
    for (const ComposePreset& preset : presets)
      EXPECT_NE(page.str().find("`" + std::string(preset.name) + "`"), std::string::npos);
  }
}

TEST(ComposeVariants, MuJoCoOpensEveryVariantTheWayWeSay) {
  for (const HingeSide side : {HingeSide::kLeft, HingeSide::kRight}) {
    for (const Opening opening : {Opening::kPull, Opening::kPush}) {
      const DoorAsset door =
          ComposeDoor(SmallBody(), SmallLever(), {.hinge_side = side, .opening = opening});
      const fs::path folder =
          ScratchFolder("variant_" + std::string(NameOf(side)) + std::string(NameOf(opening)));
      WriteDoorFolder(door, folder, Existing::kReplace);
      const MuJoCoDoor simulated(folder / "model.urdf");
      ASSERT_TRUE(simulated.ok()) << simulated.error();
      const Eigen::Vector3d com = door.links[kLeafLink].mass.center_of_mass_m;
      const double moved =
          (simulated.LinkPoses(0.6, 0)[0] * com).x() - (simulated.LinkPoses(0, 0)[0] * com).x();
      EXPECT_GT(opening == Opening::kPull ? moved : -moved, 0.1);
      // the grasp lies on the far side of the hinge
      const double along_y = DoorFromLinks(door, 0, 0)[2].translation().y();
      EXPECT_GT(side == HingeSide::kLeft ? along_y : -along_y, 0.2);
      for (const Finding& finding : ValidateDoor(folder).findings)
        EXPECT_NE(finding.code, "MEC004") << finding.where;
      fs::remove_all(folder);
    }
  }
}

TEST(ComposeVariants, EverySideOpeningAndLatchCanBeSimulated) {
  for (const ComposeConfig& config :
       {ComposeConfig{}, ComposeConfig{.hinge_side = HingeSide::kRight},
        ComposeConfig{.opening = Opening::kPush},
        ComposeConfig{.hinge_side = HingeSide::kRight,
        .opening = Opening::kPush,
        .latch = LatchChoice::kBolt},
        ComposeConfig{.unlocks_ajar = true}})
    EXPECT_NO_THROW(RequireSimulatable(ComposeDoor(SmallBody(), SmallLever(), config), "test"));
  EXPECT_NE(Refusal(SmallBody(), SmallLever(), {.relatch = true, .unlocks_ajar = true})
                .find("unlocks_ajar"),
            std::string::npos);
}

}  // namespace
}  // namespace doorforge
