// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Where handles go that were imported together with their body.

#include <gtest/gtest.h>

#include "doorforge/compose/compose.h"
#include "doorforge/core/error.h"
#include "doorforge/importers/author_place.h"
#include "doorforge/importers/import_objects.h"

#include "small_parts.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

Eigen::Vector3d HandleAt(const DoorAsset& door) {
  return DoorFromLinks(door, 0, 0)[kHandleLink].translation();
}

void ExpectAt(const DoorAsset& door, const Eigen::Vector3d& expected) {
  EXPECT_LT((HandleAt(door) - expected).norm(), 1e-9)
      << "found " << HandleAt(door).transpose() << ", expected " << expected.transpose();
}

// beyond the leaf's edge at y = 0.4 and 30 mm in front of its surface at x = 0.02
const RigidTransform kFloating = Translation({0.05, 0.395, 1.2});

TEST(ComposePlace, AnImportedHandleKeepsItsAxisAndIsLaidOnTheLeaf) {
  ExpectAt(ComposeDoor(SmallBody(), SmallLever(), {}, kFloating), {0.02, 0.395, 1.2});
  ExpectAt(ComposeDoor(SmallBody(), SmallLever(), {.place = HandlePlace::kAxis}, kFloating),
           {0.02, 0.395, 1.2});
}

TEST(ComposePlace, AuthorKeepsTheDepthTooAndSeatMovesTheBackOntoTheLeaf) {
  ExpectAt(ComposeDoor(SmallBody(), SmallLever(), {.place = HandlePlace::kAuthor}, kFloating),
           kFloating.translation());
  // of the body's mount, not of the author's place
  ExpectAt(ComposeDoor(SmallBody(), SmallLever(), {.place = HandlePlace::kSeat}, kFloating),
           {0.02, 0.32, 0.8});
}

TEST(ComposePlace, PlaneLaysTheHandlesOwnPlaneOnTheLeaf) {
  Part floating = SmallLever();
  for (PartPiece& piece : floating.pieces) Shift(piece, {0.034, 0, 0});
  ExpectAt(ComposeDoor(SmallBody(), floating, {.place = HandlePlace::kPlane}), {0.02, 0.32, 0.8});
  ExpectAt(ComposeDoor(SmallBody(), floating, {.place = HandlePlace::kSeat}),
           {0.02 - 0.034, 0.32, 0.8});
}

TEST(ComposePlace, AHandleWhoseAxisLiesInTheLeafIsNotMovedAtAll) {
  Part flap = SmallLever();
  flap.mechanism = Mechanism::kFlap;
  flap.joint.axis = Eigen::Vector3d::UnitZ();
  ExpectAt(ComposeDoor(SmallBody(), flap, {}, kFloating), kFloating.translation());
  const DoorAsset door = ComposeDoor(SmallBody(), flap, {}, kFloating);
  EXPECT_LT((door.handle_joint.axis - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(ComposePlace, ATiltedAxisIsSlidAlongItself) {
  Part lever = SmallLever();
  lever.joint.axis = Eigen::Vector3d(1, 0, 0.1).normalized();
  const Eigen::Vector3d moved =
      HandleAt(ComposeDoor(SmallBody(), lever, {}, kFloating)) - kFloating.translation();
  EXPECT_LT(moved.cross(lever.joint.axis).norm(), 1e-12);
  EXPECT_NEAR(moved.x(), -0.03, 1e-6);
}

TEST(ComposePlace, WhatLiesFarBehindAHandleIsNotWhatItSitsOn) {
  const RigidTransform far = Translation({0.3, 0.3, 1.2});
  ExpectAt(ComposeDoor(SmallBody(), SmallLever(), {}, far), far.translation());
  // beside the leaf there is nothing behind it
  const RigidTransform beside = Translation({0.05, 0.7, 1.2});
  ExpectAt(ComposeDoor(SmallBody(), SmallLever(), {}, beside), beside.translation());
}

TEST(ComposePlace, ADoorHingedRightIsTheMirrorImage) {
  ExpectAt(ComposeDoor(SmallBody(), SmallLever(), {.hinge_side = HingeSide::kRight}, kFloating),
           {0.02, -0.395, 1.2});
}

TEST(ComposePlace, OtherSettingsThatMoveTheHandleComeFirst) {
  EXPECT_NEAR(
      HandleAt(ComposeDoor(SmallBody(), SmallLever(), {.handle_height_m = 1.1}, kFloating)).z(),
      1.1, 1e-9);
  for (const HandlePlace place : {HandlePlace::kAuthor, HandlePlace::kAxis}) {
    try {
      ComposeDoor(SmallBody(), SmallLever(), {.handle_height_m = 1.1, .place = place}, kFloating);
      ADD_FAILURE() << NameOf(place) << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kInvalidConfig);
      EXPECT_NE(std::string(error.what()).find("handle_height_m"), std::string::npos);
    }
  }
}

TEST(ComposePlace, ForPartsOfDifferentObjectsThereIsNoAuthorsPlace) {
  try {
    ComposeDoor(SmallBody(), SmallLever(), {.place = HandlePlace::kAuthor});
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_NE(std::string(error.what()).find("CMP011"), std::string::npos) << error.what();
  }
}

TEST(ComposePlace, ASharedDoorHasTheSamePlace) {
  const ComposeConfig config;
  const DoorAsset alone = ComposeDoor(SmallBody(), SmallLever(), config, kFloating);
  const SharedDoor shared = ComposeSharedDoor(
      PreparedPart(SmallBody(), config), PreparedPart(SmallLever(), config), config, kFloating);
  EXPECT_EQ(shared.id, alone.id);
  // from the hinge, which is at y = -0.4
  EXPECT_NE(shared.urdf.find("0.795"), std::string::npos) << shared.urdf;
}

TEST(AuthorPlaces, AreRememberedBesideTheBodyAndAddedTo) {
  const fs::path body = TestFolder("author_places");
  fs::create_directories(body);
  EXPECT_TRUE(ReadAuthorPlaces(body).empty());
  RememberAuthorPlaces(body, {{"a", Translation({1, 2, 3})}, {"b", Translation({4, 5, 6})}});
  RememberAuthorPlaces(body, {{"b", Translation({7, 8, 9})}});
  const AuthorPlaces places = ReadAuthorPlaces(body);
  ASSERT_EQ(places.size(), 2U);
  EXPECT_EQ(places.at("a").translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(places.at("b").translation(), Eigen::Vector3d(7, 8, 9));
}

TEST(AuthorPlaces, AnImportRemembersWhereItsHandleWas) {
  const fs::path root = TestFolder("import_places");
  WriteSmallObject(root / "LeverDoor/99650069960003");
  const auto import = [&] {
    return ImportObjects(FindObjects(root / "LeverDoor"), root / "parts", {}, Existing::kRefuse)
        .objects.at(0);
  };
  const ImportedObject object = import();
  ASSERT_EQ(object.outcome, ImportOutcome::kImported) << object.message;
  const Part body = ReadPart(root / "parts" / object.body_id);
  const Part handle = ReadPart(root / "parts" / object.handle_id);
  const RigidTransform place =
      ReadAuthorPlaces(root / "parts" / object.body_id).at(handle.source_sha256);
  // this body's mount is where the one object that it comes from has its handle
  EXPECT_LT((place.translation() - body.part_from_mount.translation()).norm(), 1e-9);
  // a run that finds the parts made remembers it again
  fs::remove(root / "parts" / object.body_id / "handles.json");
  EXPECT_EQ(import().outcome, ImportOutcome::kImported);
  EXPECT_EQ(ReadAuthorPlaces(root / "parts" / object.body_id).size(), 1U);
}

}  // namespace
}  // namespace doorforge
