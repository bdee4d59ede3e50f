// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/compose/compose.h"

#include <numbers>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "doorforge/core/error.h"

#include "small_parts.h"

namespace doorforge {
namespace {

Eigen::AlignedBox3d BoxAround(const TriangleMesh& mesh, const RigidTransform& place) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(place * vertex);
  return box;
}

// of the handle link's only mesh, in the door frame at zero angles
Eigen::AlignedBox3d GripBox(const DoorAsset& door) {
  return BoxAround(door.links[kHandleLink].geometry.front().mesh,
                   DoorFromLinks(door, 0, 0)[kHandleLink]);
}

TEST(ComposeDoor, TheBackRestsOnTheLeafHoweverTheMountWasGiven) {
  for (const double error : {-0.3, -0.01, 0.0, 0.02}) {
    Part body = SmallBody();
    body.part_from_mount.translation().x() += error;
    const DoorAsset door = ComposeDoor(body, SmallLever(), {});
    EXPECT_NEAR(GripBox(door).min().x(), 0.02, 1e-6) << "mount off by " << error;
  }
}

TEST(ComposeDoor, AHandleThatFloatedOrWasSunkInItsOwnFrameIsSeatedToo) {
  for (const double error : {-0.02, 0.015}) {
    Part handle = SmallLever();
    for (PartPiece& piece : handle.pieces) Shift(piece, {error, 0, 0});
    EXPECT_NEAR(GripBox(ComposeDoor(SmallBody(), handle, {})).min().x(), 0.02, 1e-6);
  }
}

TEST(ComposeDoor, ADecorationUnderASmallPartOfTheBackDoesNotLiftTheHandle) {
  Part body = SmallBody();
  // a thin ridge 12 mm high across the mount
  TriangleMesh ridge = BoxMesh({0.02, 0.32, 0.799}, {0.032, 0.3205, 0.801});
  PartPiece& leaf = body.pieces[1];
  leaf.mesh = Together(leaf.mesh, ridge);
  EXPECT_NEAR(GripBox(ComposeDoor(body, SmallLever(), {})).min().x(), 0.02, 1e-6);
}

TEST(ComposeDoor, TheBackStaysInsideTheLeafsOutline) {
  Part body = SmallBody();
  body.part_from_mount = Translation({0.02, 0.399, 1.599});
  const DoorAsset door = ComposeDoor(body, SmallLever(), {});
  // the neck of the lever reaches 12.5 mm to each side of the axis
  const Eigen::Vector3d axis = DoorFromLinks(door, 0, 0)[kHandleLink].translation();
  EXPECT_NEAR(axis.y(), 0.4 - 0.0125, 1e-6);
  EXPECT_NEAR(axis.z(), 1.6 - 0.01125, 1e-6);
}

TEST(ComposeDoor, KeepsTheAuthorsMountOtherwise) {
  const DoorAsset door = ComposeDoor(SmallBody(), SmallLever(), {});
  EXPECT_LT(
      (DoorFromLinks(door, 0, 0)[kHandleLink].translation() - Eigen::Vector3d(0.02, 0.32, 0.8))
          .norm(),
      1e-6);
}

TEST(ComposeDoor, HeightAndBacksetMoveTheHandle) {
  const DoorAsset door =
      ComposeDoor(SmallBody(), SmallLever(), {.handle_height_m = 1.1, .backset_m = 0.06});
  EXPECT_LT(
      (DoorFromLinks(door, 0, 0)[kHandleLink].translation() - Eigen::Vector3d(0.02, 0.34, 1.1))
          .norm(),
      1e-6);
}

TEST(ComposeDoor, PositiveAnglesOpenTowardsXAndPressTheLeverDown) {
  const DoorAsset door = ComposeDoor(SmallBody(), SmallLever(), {});
  const auto shut = DoorFromLinks(door, 0, 0);
  const auto open = DoorFromLinks(door, std::numbers::pi / 4, 0);
  const auto pressed = DoorFromLinks(door, 0, std::numbers::pi / 4);
  const Eigen::Vector3d grasp = door.handle_from_grasp.translation();
  EXPECT_GT((open[kHandleLink] * grasp).x(), (shut[kHandleLink] * grasp).x() + 0.3);
  EXPECT_LT((pressed[kHandleLink] * grasp).z(), (shut[kHandleLink] * grasp).z() - 0.04);
  // the hinge line itself does not move
  EXPECT_LT((open[kLeafLink].translation() - shut[kLeafLink].translation()).norm(), 1e-12);
}

TEST(ComposeDoor, MassesOfALinkAreThoseOfItsPieces) {
  const Part body = SmallBody();
  Part handle = SmallLever();
  handle.pieces.push_back(MakeSolid("rose", BoxMesh({0, -0.02, -0.02}, {0.005, 0.02, 0.02}), 0.1));
  const DoorAsset door = ComposeDoor(body, handle, {});
  EXPECT_NEAR(door.links[kLeafLink].mass.mass_kg, FindPiece(body, "leaf")->mass.mass_kg + 0.1,
              1e-12);
  EXPECT_EQ(door.links[kLeafLink].geometry.size(), 2U);
  EXPECT_EQ(door.links[kLeafLink].geometry[1].label, PointLabel::kHandle);
  // the leaf's centre of mass lies at half its width from the hinge
  EXPECT_NEAR(door.links[kLeafLink].mass.center_of_mass_m.y(), 0.4, 0.01);
  const double smallest =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(door.links[kHandleLink].mass.inertia_kg_m2)
          .eigenvalues()[0];
  EXPECT_GE(smallest, kMinimumHandleInertia * (1 - 1e-9));
}

TEST(ComposeDoor, ABodyWithoutAFrameStillHasABaseWithMass) {
  Part body = SmallBody();
  std::erase_if(body.pieces, [](const PartPiece& piece) { return piece.name == "frame"; });
  EXPECT_GT(ComposeDoor(body, SmallLever(), {}).links[kBaseLink].mass.mass_kg, 0);
}

TEST(ComposeDoor, TheLatchFollowsTheMechanism) {
  const DoorAsset lever = ComposeDoor(SmallBody(), SmallLever(), {});
  EXPECT_EQ(lever.latch.type, LatchType::kEffort);
  EXPECT_NEAR(lever.latch.unlock_angle_rad, 29.25 * std::numbers::pi / 180, 1e-9);
  EXPECT_NEAR(lever.latch.handle_done_angle_rad, 33.75 * std::numbers::pi / 180, 1e-9);
  EXPECT_EQ(ComposeDoor(SmallBody(), SmallLever(), {.latch = LatchChoice::kNone}).latch.type,
            LatchType::kNone);
  Part pull = SmallLever();
  pull.mechanism = Mechanism::kNone;
  pull.joint.upper_rad = 0;
  const DoorAsset plain = ComposeDoor(SmallBody(), pull, {});
  EXPECT_EQ(plain.latch.type, LatchType::kNone);
  EXPECT_DOUBLE_EQ(plain.handle_joint.upper_rad, 0);
  const DoorAsset tuned =
      ComposeDoor(SmallBody(), SmallLever(), {.lock_effort_nm = 40, .relatch = true});
  EXPECT_DOUBLE_EQ(tuned.latch.lock_effort_nm, 40);
  EXPECT_TRUE(tuned.latch.relatch);
}

void ExpectRefused(const Part& body, const Part& handle, const ComposeConfig& config,
                   ErrorCode code) {
  try {
    ComposeDoor(body, handle, config);
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
  }
}

TEST(ComposeDoor, RefusesWhatDoesNotBelongTogether) {
  const Part body = SmallBody();
  const Part lever = SmallLever();
  ExpectRefused(lever, body, {}, ErrorCode::kInvalidArgument);
  Part other = lever;
  other.category = Category::kSafe;
  ExpectRefused(body, other, {}, ErrorCode::kInvalidArgument);
  Part huge = lever;
  huge.pieces[0] = MakeSolid("grip", BoxMesh({0, -1, -1}, {0.05, 1, 1}), 1);
  ExpectRefused(body, huge, {}, ErrorCode::kInvalidArgument);
  ExpectRefused(body, lever, {.handle_height_m = -1}, ErrorCode::kInvalidConfig);
  ExpectRefused(body, lever, {.lock_effort_nm = 1e9}, ErrorCode::kInvalidConfig);
  Part bare = body;
  bare.pieces.clear();
  ExpectRefused(bare, lever, {}, ErrorCode::kInvalidArgument);
}

TEST(ComposeDoor, RecordsItsPartsAndTheirLicences) {
  Part body = SmallBody();
  body.license = "CC-BY-4.0";
  const DoorAsset door = ComposeDoor(body, SmallLever(), {});
  EXPECT_EQ(door.id, "small_body__small_lever");
  EXPECT_EQ(door.license, "CC-BY-4.0 AND CC0-1.0");
  EXPECT_EQ(door.body.sha256, ContentHash(body));
  EXPECT_EQ(ComposeDoor(body, SmallLever(), {.id = "mine"}).id, "mine");
}

}  // namespace
}  // namespace doorforge
