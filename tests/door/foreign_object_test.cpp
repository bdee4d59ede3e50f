// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/importers/foreign_object.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

#include "foreign_objects.h"
#include "formats/import_unidoormanip.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

constexpr double kHalfHeight = 0.5;  // a SmallCabinet is 2 units high and imported 1 m high

Eigen::AlignedBox3d BoundsOf(const PartDraft& draft, const std::string& piece) {
  Eigen::AlignedBox3d bounds;
  for (const RawPiece& raw : draft.pieces) {
    if (raw.name != piece) continue;
    for (const Eigen::Vector3d& vertex : raw.mesh.vertices) bounds.extend(vertex);
  }
  return bounds;
}

std::vector<ForeignObject> ReadAll(const fs::path& path, const ReadConfig& config = {},
                                   const std::string& format = "auto") {
  std::vector<ForeignObject> objects;
  for (const ForeignSource& source : FindObjects(path, format)) {
    for (ForeignObject& object : ReadObjects(source, config)) objects.push_back(std::move(object));
  }
  return objects;
}

ForeignObject ReadOne(const fs::path& path, const ReadConfig& config = {},
                      const std::string& format = "auto") {
  std::vector<ForeignObject> objects = ReadAll(path, config, format);
  EXPECT_EQ(objects.size(), 1U);
  EXPECT_EQ(objects.at(0).refusal, "");
  return objects.at(0);
}

PartDraft Load(const ForeignObject& object, PartRole role) {
  for (const ForeignPart& part : object.parts) {
    if (part.role == role) return part.load().draft;
  }
  throw std::runtime_error("no such part");
}

bool NotesSay(const ForeignObject& object, const std::string& part) {
  return std::ranges::any_of(
      object.notes, [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

void ExpectError(const fs::path& path, ErrorCode code, const std::string& part,
                 const ReadConfig& config = {}) {
  try {
    ReadAll(path, config);
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

fs::path Cabinet(const std::string& test, const SmallCabinet& cabinet = {}) {
  const fs::path folder = TestFolder(test) / "45001";
  WriteSmallCabinet(folder, cabinet);
  return folder;
}

TEST(PartNetMobility, ScalesToMetresAndPutsTheHingeWhereTheUrdfSays) {
  const ForeignObject object = ReadOne(Cabinet("partnet_frames"));
  EXPECT_EQ(object.name, "partnet-mobility/45001");
  EXPECT_EQ(object.category, "storagefurniture");
  EXPECT_NEAR(object.scale, kHalfHeight, 1e-12);
  const PartDraft body = Load(object, PartRole::kBody);
  // link (x, y, z) -> ours (z, x, y), half as large, standing on the floor
  ExpectNear(body.facts.joint.origin_m, {0.1125, -0.225, 0.5}, 1e-9);
  ExpectNear(body.facts.joint.axis, {0, 0, -1}, 1e-12);
  EXPECT_NEAR(body.facts.joint.upper_rad, 1.5, 1e-12);
  const Eigen::AlignedBox3d leaf = BoundsOf(body, "leaf");
  ExpectNear(leaf.min(), {0.1, -0.225, 0.05}, 1e-6);
  ExpectNear(leaf.max(), {0.125, 0.225, 0.95}, 1e-6);
  EXPECT_NEAR(BoundsOf(body, "frame").min().z(), 0, 1e-9);
}

TEST(PartNetMobility, AHandleThatIsAVisualOfItsLeafBecomesAPart) {
  const ForeignObject object = ReadOne(Cabinet("partnet_fixed"));
  ASSERT_EQ(object.parts.size(), 2U);
  const PartDraft handle = Load(object, PartRole::kHandle);
  EXPECT_EQ(handle.facts.mechanism, Mechanism::kNone);
  EXPECT_EQ(handle.facts.joint.upper_rad, 0);
  const Eigen::AlignedBox3d grip = BoundsOf(handle, "grip");
  ExpectNear(grip.min(), {0, -0.005, -0.1}, 1e-6);
  ExpectNear(grip.max(), {0.025, 0.005, 0.1}, 1e-6);
  // it lies on the leaf's front
  const Part body = Load(object, PartRole::kBody).facts;
  ExpectNear(body.part_from_mount.translation(), {0.125, 0.19, 0.5}, 1e-6);
  // fingers approach the leaf and close across an upright bar
  ExpectNear(handle.facts.part_from_grasp.linear().col(2), {-1, 0, 0}, 1e-12);
  ExpectNear(handle.facts.part_from_grasp.linear().col(1), {0, 1, 0}, 1e-12);
}

TEST(PartNetMobility, AKnobTurnsAlsoWhereTheUrdfWasFixed) {
  for (const char* type : {"continuous", "fixed"}) {
    SCOPED_TRACE(type);
    const ForeignObject object = ReadOne(
        Cabinet(std::string("partnet_knob_") + type, {.handle = "knob", .knob_type = type}));
    const Part handle = Load(object, PartRole::kHandle).facts;
    EXPECT_EQ(handle.mechanism, Mechanism::kRound);
    EXPECT_NEAR(handle.joint.upper_rad, std::numbers::pi / 4, 1e-12);
    ExpectNear(handle.joint.axis, {1, 0, 0}, 1e-12);
    const Part body = Load(object, PartRole::kBody).facts;
    ExpectNear(body.part_from_mount * handle.joint.origin_m, {0.125, 0.19, 0.55}, 1e-6);
  }
}

TEST(PartNetMobility, ADoorHingedOnTheRightIsMirrored) {
  const ForeignObject left = ReadOne(Cabinet("partnet_left", {.handle = "knob"}));
  const ForeignObject right =
      ReadOne(Cabinet("partnet_right", {.hinge_right = true, .handle = "knob"}));
  EXPECT_FALSE(left.mirrored);
  EXPECT_TRUE(right.mirrored);
  // the fixtures are mirror images, and the mirror of a closed mesh is closed again
  const PartDraft a = Load(left, PartRole::kBody);
  const PartDraft b = Load(right, PartRole::kBody);
  ExpectNear(a.facts.joint.origin_m, b.facts.joint.origin_m, 1e-9);
  ExpectNear(a.facts.joint.axis, b.facts.joint.axis, 1e-12);
  ExpectNear(a.facts.part_from_mount.translation(), b.facts.part_from_mount.translation(), 1e-6);
  for (const RawPiece& piece : b.pieces) {
    const std::optional<ClosedMesh> closed = ClosedMesh::From(piece.mesh);
    EXPECT_TRUE(closed.has_value()) << piece.name;
  }
}

TEST(PartNetMobility, ALeafAuthoredAjarIsClosed) {
  const double ajar = std::numbers::pi / 5;
  for (const bool right : {false, true}) {
    const std::string name = right ? "partnet_ajar_right" : "partnet_ajar_left";
    const ForeignObject object =
        ReadOne(Cabinet(name, {.hinge_right = right, .ajar_rad = ajar, .handle = "fixed"}));
    const PartDraft body = Load(object, PartRole::kBody);
    ExpectNear(BoundsOf(body, "leaf").sizes(), {0.025, 0.45, 0.9}, 1e-5);
    EXPECT_NEAR(body.facts.joint.upper_rad, 1.5, 1e-9);
    ExpectNear(body.facts.part_from_mount.translation(), {0.125, 0.19, 0.5}, 1e-5);
  }
}

TEST(PartNetMobility, WhatIsNoDoorIsRefusedWithTheReason) {
  const auto refusal = [](const std::string& test, const SmallCabinet& cabinet) {
    const std::vector<ForeignObject> objects = ReadAll(Cabinet(test, cabinet));
    EXPECT_EQ(objects.size(), 1U);
    EXPECT_TRUE(objects[0].parts.empty());
    return objects[0].refusal;
  };
  EXPECT_NE(refusal("partnet_lid", {.handle = "none", .lid = true}).find("lid"), std::string::npos);
  EXPECT_NE(refusal("partnet_kind", {.model_kind = "Laptop"}).find("Laptop"), std::string::npos);
  EXPECT_EQ(
      ReadOne(Cabinet("partnet_kind_told", {.model_kind = "Laptop"}), {.category = "refrigerator"})
          .category,
      "refrigerator");
  // a knob on the body alone
  const fs::path folder = Cabinet("partnet_body_knob");
  WriteText(folder / "semantics.txt", "link_0 hinge knob\nlink_1 heavy washing_machine_body\n");
  EXPECT_NE(ReadAll(folder)[0].refusal.find("not on a leaf"), std::string::npos);
}

TEST(PartNetMobility, EveryLeafGivesADoorAndDrawersStay) {
  const fs::path folder = Cabinet("partnet_two");
  std::string urdf = CabinetUrdf({});
  urdf.insert(urdf.find("</robot>"),
              LinkText("link_5", "door-7", "textured_objs/knob.obj", {0, 0, 0}) +
                  TextOf({.name = "j5",
                          .type = "prismatic",
                          .parent = "link_1",
                          .child = "link_5",
                          .axis = {0, 0, 1},
                          .limit = "lower=\"0\" upper=\"0.5\""}) +
                  LinkText("link_6", "door-8", "textured_objs/leaf.obj", {-0.45, 0, -0.225}) +
                  TextOf({.name = "j6",
                          .parent = "link_1",
                          .child = "link_6",
                          .origin = {0.45, 0, 0.225},
                          .axis = {0, 1, 0},
                          .limit = "lower=\"0\" upper=\"1.5\""}));
  WriteText(folder / "mobility.urdf", urdf);
  const std::vector<ForeignObject> objects = ReadAll(folder);
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].name, "partnet-mobility/45001/link_0");
  EXPECT_EQ(objects[1].parts[0].id, "pm-45001-link_6");
  EXPECT_EQ(objects[1].parts.size(), 1U);  // no handle, so a body alone
  EXPECT_TRUE(NotesSay(objects[0], "slides"));
}

TEST(PartNetMobility, FaultsOfFilesAreToldWithTheirNames) {
  const fs::path folder = Cabinet("partnet_faults");
  fs::remove(folder / "textured_objs/frame.obj");
  ExpectError(folder, ErrorCode::kMissing, "textured_objs/frame.obj");
  EXPECT_EQ(ReadOne(folder, {.allow_missing = "frame"}).parts.size(), 2U);
  ExpectError(folder, ErrorCode::kInvalidArgument, "frame", {.allow_missing = "leaf"});
  fs::remove(folder / "textured_objs/leaf.obj");
  ExpectError(folder, ErrorCode::kMissing, "textured_objs/leaf.obj", {.allow_missing = "frame"});
  WriteText(folder / "textured_objs/leaf.obj", "no mesh");
  ExpectError(folder, ErrorCode::kFormat, "leaf.obj", {.allow_missing = "frame"});
  WriteText(folder / "meta.json", "{");
  ExpectError(folder, ErrorCode::kFormat, "meta.json", {.allow_missing = "frame"});
  WriteText(folder / "semantics.txt", "link_0");
  ExpectError(folder, ErrorCode::kFormat, "semantics.txt:1", {.allow_missing = "frame"});
}

TEST(GaPartNet, TakesTheAnnotatedHandleLinkAndChecksItsBox) {
  const fs::path folder = Cabinet("gapartnet");
  WriteText(folder / "mobility_annotation_gapartnet.urdf", CabinetUrdf({}, "link_3"));
  // in the base's frame: link x -> -y, link y -> z, link z -> -x
  const auto annotation = [](double top) {
    std::string corners;
    for (int i = 0; i < 8; ++i)
      corners += std::string(i == 0 ? "" : ", ") + "[" + ((i & 1) != 0 ? "-0.3" : "-0.25") + ", " +
                 ((i & 2) != 0 ? "-0.37" : "-0.39") + ", " +
                 ((i & 4) != 0 ? std::to_string(top) : "-0.2") + "]";
    return "[{\"link_name\": \"link_3\", \"is_gapart\": true, \"category\": "
           "\"line_fixed_handle\", \"bbox\": [" +
           corners + "]}, {\"link_name\": \"link_1\", \"is_gapart\": false}]";
  };
  WriteText(folder / "link_annotation_gapartnet.json", annotation(0.2));
  const ForeignObject object = ReadOne(folder);
  EXPECT_EQ(object.name, "gapartnet/45001");
  ASSERT_EQ(object.parts.size(), 2U);
  EXPECT_LT(object.parts[1].load().box_deviation_m, 1e-6);
  ExpectNear(BoundsOf(Load(object, PartRole::kHandle), "grip").max(), {0.025, 0.005, 0.1}, 1e-6);
  WriteText(folder / "link_annotation_gapartnet.json", annotation(0.3));
  EXPECT_NEAR(ReadOne(folder).parts[1].load().box_deviation_m, 0.1 * kHalfHeight, 1e-6);
}

// u of Unity stands for (u.y, u.z, u.x) of the meshes; readers disagree on the second one's sign
Eigen::Vector3d InUnity(const Eigen::Vector3d& v, double second_sign) {
  return {v.z(), v.x(), second_sign * v.y()};
}

TEST(Akb48, TurnsUnitysAxesAndFindsTheSignThatItsReadersDisagreeOn) {
  for (const double sign : {1.0, -1.0}) {
    const fs::path folder = TestFolder("akb48") / "0c1d-00";
    // meshes: x up; the leaf opens about an upright line at its edge
    WriteText(folder / "box.obj", ToObj(Box({0, -0.3, -0.2}, {0.8, 0.5, 0.18})));
    WriteText(folder / "door.obj", ToObj(Box({0.02, -0.28, 0.18}, {0.78, 0.48, 0.2})));
    const Eigen::Vector3d hinge(0.4, -0.28, 0.19);
    WriteText(folder / "motion_unity.urdf",
              "<robot name=\"r\">" + LinkText("body", "", "package://box.obj", {0, 0, 0}) +
                  LinkText("door", "", "package://door.obj", {0, 0, 0}) +
                  TextOf({.name = "j",
                          .parent = "body",
                          .child = "door",
                          .origin = InUnity(hinge, sign),
                          .axis = InUnity({-1, 0, 0}, 1),
                          .limit = "lower=\"0\" upper=\"1.4\""}) +
                  "</robot>");
    ExpectError(folder, ErrorCode::kInvalidArgument, "--category");
    const ForeignObject object = ReadOne(folder, {.category = "storagefurniture"});
    const PartDraft body = Load(object, PartRole::kBody);
    const Eigen::AlignedBox3d leaf = BoundsOf(body, "leaf");
    ExpectNear(leaf.sizes(), {0.02, 0.76, 0.76}, 1e-6);
    // the hinge lies on the leaf's edge, in the middle of its thickness
    EXPECT_NEAR(body.facts.joint.origin_m.y(), leaf.min().y(), 1e-6);
    EXPECT_NEAR(body.facts.joint.origin_m.x(), leaf.center().x(), 1e-6);
    EXPECT_NEAR(std::abs(body.facts.joint.axis.z()), 1, 1e-12);
  }
}

TEST(DoorGym, ScalesEachKindOfHandleAndTurnsItOutOfTheDoor) {
  const fs::path root = TestFolder("doorgym");
  // z out of the door, the lever along -x [mm]
  const auto write = [&](const std::string& kind) {
    const fs::path folder = root / kind / "1551";
    WriteText(folder / "body_1.stl", ToStl(Box({-10, -10, 0}, {10, 10, 40})));
    WriteText(folder / "body_2.stl", ToStl(Box({-80, -8, 40}, {10, 8, 50})));
    WriteText(folder / "info.json",
              "{\"version\": 2, \"model_names\": [\"body_1\", \"body_2\"], \"bounding_box\": "
              "[{\"min\": [-80, -10, 0], \"max\": [10, 10, 50]}]}");
    return folder;
  };
  const ForeignObject lever = ReadOne(write("leverknobs"));
  EXPECT_EQ(lever.mechanism, "lever");
  EXPECT_LT(lever.parts[0].load().box_deviation_m, 1e-9);
  const PartDraft handle = Load(lever, PartRole::kHandle);
  ExpectNear(BoundsOf(handle, "grip").max(), {0.075, 0.015, 0.015}, 1e-9);
  ExpectNear(BoundsOf(handle, "grip").min(), {0, -0.12, -0.015}, 1e-9);
  // the lever reaches towards the hinge and is pressed down by a positive angle
  const Eigen::Vector3d tip = handle.facts.part_from_grasp.translation();
  EXPECT_LT(tip.y(), -0.05);
  EXPECT_LT(handle.facts.joint.axis.cross(tip).z(), 0);
  EXPECT_EQ(handle.facts.license, "BSD-3-Clause");
  EXPECT_EQ(ReadOne(write("roundknobs")).scale, 0.001);
  EXPECT_EQ(ReadOne(write("pullknobs")).mechanism, "none");
  fs::remove(root / "pullknobs/1551/body_2.stl");
  ExpectError(root / "pullknobs", ErrorCode::kMissing, "body_2.stl");
  ExpectError(write("otherknobs"), ErrorCode::kInvalidArgument, "otherknobs");
}

// the parts that WriteSmallObject() composes, as a package of bodies and handles
struct SmallPackage {
  fs::path root;
  fs::path body() const { return root / "3dware_door/9965006"; }
  fs::path handle(const std::string& kind = "lever_door_handle") const {
    return root / kind / "9960003";
  }
};

SmallPackage WritePackage(const std::string& test) {
  SmallPackage package{TestFolder(test) / "assets"};
  WriteText(package.body() / "bounding_box.json",
            R"({"min": [-0.56, -0.05, -1], "max": [0.56, 0.05, 1.06]})");
  WriteText(package.body() / "texture_dae/frame.obj", ToObj(RawFrame()));
  WriteText(package.body() / "texture_dae/board.obj", ToObj(RawBoard()));
  WriteText(package.handle() / "bounding_box.json",
            R"({"handle": [[-0.12, -0.055, -0.009], [0.01, 0, 0.009]]})");
  WriteText(package.handle() / "texture_dae/9960003.obj", ToObj(RawLever()));
  WriteText(package.handle() / "goal_pos.npy", TorchFile(-0.06F, 0, 0.0475F));
  return package;
}

TEST(UniDoorManipParts, GiveTheDoorThatTheReleaseComposesOfThem) {
  const SmallPackage package = WritePackage("package");
  // the scales that the release's scripts would draw in the middle of their ranges
  const fs::path composed = package.root / "LeverDoor/99650069960003";
  WriteSmallObject(composed, {.body_scale = 1.8 / 2.06, .handle_scale = 0.15 / 0.13});
  const UniDoorManipObject expected = ReadUniDoorManip(composed, "");
  const std::vector<ForeignObject> parts = ReadAll(package.root / "3dware_door");
  ASSERT_EQ(parts.size(), 1U);
  const PartDraft body = Load(parts[0], PartRole::kBody);
  const PartDraft body_there = LoadBody(expected);
  EXPECT_EQ(body.facts.id, "udm-9965006");
  // texts of a URDF in the release hold six digits
  ExpectNear(body.facts.joint.origin_m, body_there.facts.joint.origin_m, 1e-5);
  ExpectNear(body.facts.joint.axis, body_there.facts.joint.axis, 1e-9);
  ExpectNear(body.facts.part_from_mount.translation(),
             body_there.facts.part_from_mount.translation(), 1e-5);
  ExpectNear(BoundsOf(body, "leaf").max(), BoundsOf(body_there, "leaf").max(), 1e-5);
  const ForeignObject read = ReadOne(package.handle());
  const PartDraft handle = Load(read, PartRole::kHandle);
  const PartDraft handle_there = LoadHandle(expected);
  ExpectNear(handle.facts.joint.axis, handle_there.facts.joint.axis, 1e-9);
  EXPECT_EQ(handle.facts.joint.upper_rad, handle_there.facts.joint.upper_rad);
  ExpectNear(handle.facts.part_from_grasp.translation(),
             handle_there.facts.part_from_grasp.translation(), 1e-5);
  EXPECT_LT(read.parts[0].load().box_deviation_m, 1e-6);
}

TEST(UniDoorManipParts, HandlesOfRoundDoorsServeCabinetsToo) {
  const SmallPackage package = WritePackage("package_round");
  fs::create_directories(package.root / "round_door_handle");
  fs::rename(package.handle(), package.handle("round_door_handle"));
  const std::vector<ForeignObject> both = ReadAll(package.handle("round_door_handle"));
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[0].category, "interior");
  EXPECT_EQ(both[1].category, "storagefurniture");
  EXPECT_EQ(both[1].parts[0].id, "udm-9960003-cabinet");
  EXPECT_EQ(ReadAll(package.handle("round_door_handle"), {.category = "storagefurniture"}).size(),
            1U);
  ExpectError(package.handle("round_door_handle"), ErrorCode::kInvalidArgument, "safe",
              {.category = "safe"});
}

TEST(UniDoorManipParts, TwoMeshesAreARoseAndAGrip) {
  const SmallPackage package = WritePackage("package_rose");
  const fs::path folder = package.handle() / "texture_dae";
  fs::rename(folder / "9960003.obj", folder / "9960003-handle-right.obj");
  ExpectError(package.handle(), ErrorCode::kMissing, "9960003-lock-right.dae");
  WriteText(folder / "9960003-lock-right.obj", ToObj(RawBoard()));
  const PartDraft handle = Load(ReadOne(package.handle()), PartRole::kHandle);
  ASSERT_EQ(handle.pieces.size(), 2U);
  EXPECT_EQ(handle.pieces[0].name, "rose");
  EXPECT_EQ(handle.pieces[1].name, "grip");
}

TEST(UniDoorManipParts, AllSevenTasksHaveTheirFolders) {
  const fs::path root = TestFolder("package_tasks");
  const auto body = [&](const std::string& folder, const std::string& leaf,
                        const std::string& frame) {
    const fs::path part = root / folder / "9967001";
    WriteText(part / "bounding_box.json",
              R"({"min": [-0.56, -0.05, -1], "max": [0.56, 0.05, 1.06]})");
    WriteText(part / "texture_dae" / (leaf + ".obj"), ToObj(RawBoard()));
    if (!frame.empty()) WriteText(part / "texture_dae" / (frame + ".obj"), ToObj(RawFrame()));
    return ReadOne(part);
  };
  EXPECT_EQ(body("3dware_window", "untitled1", "untitled").category, "window");
  EXPECT_EQ(body("3dware_safe", "board", "frame").category, "safe");
  EXPECT_EQ(body("3dware_cabinet", "board", "frame").category, "storagefurniture");
  EXPECT_EQ(body("3dware_fridge", "board", "frame").category, "refrigerator");
  // a car's door is in metres, a whole car is made 4 m long
  EXPECT_EQ(body("3dware_car", "car-door", "").scale, 1);
  EXPECT_NEAR(body("3dware_car", "car-door", "car-board").scale, 4 / 1.12, 1e-9);
  const auto handle = [&](const std::string& folder) {
    const fs::path part = root / folder / "9960003";
    WriteText(part / "bounding_box.json",
              R"({"handle": [[-0.12, -0.055, -0.009], [0.01, 0, 0.009]]})");
    WriteText(part / "texture_dae/9960003.obj", ToObj(RawLever()));
    WriteText(part / "goal_pos.npy", TorchFile(-0.06F, 0, 0.0475F));
    return Load(ReadOne(part), PartRole::kHandle).facts;
  };
  EXPECT_EQ(handle("window_handle").category, Category::kWindow);
  EXPECT_EQ(handle("safe_handle").mechanism, Mechanism::kValve);
  EXPECT_EQ(handle("fridge_handle").category, Category::kRefrigerator);
  const Part flap = handle("car_handle");
  EXPECT_EQ(flap.mechanism, Mechanism::kFlap);
  EXPECT_NEAR(std::abs(flap.joint.axis.z()), 1, 1e-12);
  EXPECT_NEAR(flap.joint.upper_rad, std::numbers::pi / 18, 1e-12);
}

TEST(UniDoorManipParts, ABrokenGoalIsRefusedWhereverItIsCut) {
  const SmallPackage package = WritePackage("package_goal");
  const std::string whole = TorchFile(1, 2, 3);
  const auto read = [&](const std::string& bytes) {
    WriteText(package.handle() / "goal_pos.npy", bytes);
    ReadAll(package.handle());
  };
  EXPECT_NO_THROW(read(whole));
  for (std::size_t size = 0; size < whole.size(); size += 7)
    EXPECT_THROW(read(whole.substr(0, size)), Error) << size;
  // every single byte changed: an Error or three numbers, never anything else
  for (std::size_t at = 0; at < whole.size(); at += 5) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x5a);
    try {
      read(changed);
    } catch (const Error&) {
    }
  }
  EXPECT_THROW(read("not a tensor"), Error);
}

std::string UrdfDoor(const std::string& mesh) {
  return "<robot name=\"gate\"><link name=\"post\"><visual><origin xyz=\"0 0 1\"/><geometry><box "
         "size=\"0.1 0.1 2\"/></geometry></visual></link><link name=\"leaf\"><visual><origin "
         "xyz=\"0.5 0 0\"/><geometry>" +
         mesh +
         "</geometry></visual></link><link name=\"lever\"><visual><origin xyz=\"-0.06 -0.05 0\"/>"
         "<geometry><box size=\"0.14 0.02 0.02\"/></geometry></visual><visual><origin "
         "xyz=\"0 -0.03 0\" rpy=\"1.570796326794897 0 0\"/><geometry><cylinder radius=\"0.01\" "
         "length=\"0.02\"/></geometry></visual></link>" +
         TextOf({.name = "hinge",
                 .parent = "post",
                 .child = "leaf",
                 .origin = {0, 0, 1},
                 .axis = {0, 0, -1},
                 .limit = "lower=\"0\" upper=\"1.4\""}) +
         TextOf({.name = "turn",
                 .parent = "leaf",
                 .child = "lever",
                 .origin = {0.9, 0, 0},
                 .axis = {0, 1, 0},
                 .limit = "lower=\"0\" upper=\"0.8\""}) +
         "</robot>";
}

TEST(PlainUrdf, BoxesAndCylindersMakeADoorThatOpensTowardsX) {
  const fs::path folder = TestFolder("urdf_boxes");
  WriteText(folder / "gate.urdf", UrdfDoor("<box size=\"1 0.04 1.9\"/>"));
  EXPECT_TRUE(NotesSay(ReadOne(folder / "gate.urdf"), "--category"));  // guessed, and said
  const ForeignObject object = ReadOne(folder / "gate.urdf", {.category = "interior"});
  EXPECT_EQ(object.mechanism, "lever");
  const PartDraft body = Load(object, PartRole::kBody);
  const PartDraft handle = Load(object, PartRole::kHandle);
  ExpectNear(BoundsOf(body, "leaf").sizes(), {0.04, 1, 1.9}, 1e-9);
  // opening swings the leaf to +x, the lever stands out there and goes down
  const Part& facts = body.facts;
  EXPECT_GT(facts.joint.axis.cross(BoundsOf(body, "leaf").center() - facts.joint.origin_m).x(), 0);
  EXPECT_GT(BoundsOf(body, "leaf").center().y(), facts.joint.origin_m.y());
  EXPECT_NEAR(BoundsOf(handle, "grip").sizes().x(), 0.04, 1e-6);
  const Eigen::Vector3d tip = handle.facts.part_from_grasp.translation();
  EXPECT_LT(handle.facts.joint.axis.cross(tip).z(), 0);
}

TEST(PlainUrdf, MeshesOfARosPackageAreFoundAndOthersRefused) {
  const fs::path folder = TestFolder("urdf_package") / "gate_description";
  WriteText(folder / "meshes/leaf.obj", ToObj(Box({-0.5, -0.02, -0.95}, {0.5, 0.02, 0.95})));
  const auto with_mesh = [&](const std::string& name) {
    WriteText(folder / "urdf/gate.urdf", UrdfDoor("<mesh filename=\"" + name + "\"/>"));
  };
  for (const char* name : {"package://gate_description/meshes/leaf.obj", "../meshes/leaf.obj"}) {
    with_mesh(name);
    EXPECT_EQ(ReadOne(folder / "urdf/gate.urdf", {.category = "interior"}).parts.size(), 2U);
  }
  for (const char* name : {"../../leaf.obj", "file:///leaf.obj", "/leaf.obj"}) {
    with_mesh(name);
    ExpectError(folder, ErrorCode::kFormat, "leaf.obj", {.category = "interior"});
  }
}

TEST(LooseMesh, FlagsTurnAFileIntoAHandle) {
  const fs::path folder = TestFolder("mesh_handle");
  // y up, z out, in mm: the raw lever of the small object turned that way
  TriangleMesh lever = RawLever();
  for (Eigen::Vector3d& v : lever.vertices) v = 1000 * Eigen::Vector3d(v.x(), v.z(), -v.y());
  WriteText(folder / "my_lever.stl", ToStl(lever));
  ReadConfig config{.category = "interior"};
  EXPECT_THROW(ReadAll(folder / "my_lever.stl", config), Error);  // no role
  config.mesh = {.role = "handle", .mechanism = "lever", .unit = "mm", .up = "y", .front = "z"};
  const PartDraft handle = Load(ReadOne(folder / "my_lever.stl", config), PartRole::kHandle);
  EXPECT_EQ(handle.facts.id, "my_lever");
  ExpectNear(BoundsOf(handle, "grip").min(), {0, -0.12, -0.009}, 1e-6);
  ExpectNear(BoundsOf(handle, "grip").max(), {0.055, 0.01, 0.009}, 1e-6);
  ExpectNear(handle.facts.joint.origin_m, {0, 0, 0}, 1e-6);
  // the same point told by the user
  config.mesh.mount = {-50, 0, 10};
  const PartDraft moved = Load(ReadOne(folder / "my_lever.stl", config), PartRole::kHandle);
  ExpectNear(BoundsOf(moved, "grip").min(), {-0.01, -0.07, -0.009}, 1e-6);
  for (const auto& wrong :
       {LooseMeshConfig{.role = "lid"}, LooseMeshConfig{.role = "handle", .mechanism = "magic"},
        LooseMeshConfig{.role = "handle", .unit = "yard"},
        LooseMeshConfig{.role = "handle", .scale = {1, 2}},
        LooseMeshConfig{.role = "handle", .up = "z", .front = "-z"},
        LooseMeshConfig{.role = "handle", .up = "w"},
        LooseMeshConfig{.role = "body", .hinge = "top"}}) {
    config.mesh = wrong;
    ExpectError(folder / "my_lever.stl", ErrorCode::kInvalidArgument, "", config);
  }
}

std::string Direction(const Eigen::Vector3d& d) {
  return std::to_string(d.x()) + "," + std::to_string(d.y()) + "," + std::to_string(d.z());
}

// Finds the point that is farthest from all others; their order does not matter.
double FarthestFrom(const std::vector<Eigen::Vector3d>& others,
                    const std::vector<Eigen::Vector3d>& points) {
  double farthest = 0;
  for (const Eigen::Vector3d& point : points) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& other : others) nearest = std::min(nearest, (point - other).norm());
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

TEST(LooseMesh, AFileThatLiesSkewGivesThePartOfOneThatLiesAlongItsAxes) {
  const fs::path folder = TestFolder("mesh_skew");
  const Eigen::Vector3d mount(-0.05, 0.01, 0);
  ReadConfig config{.category = "interior",
                    .mesh = {.role = "handle",
                             .mechanism = "lever",
                             .unit = "m",
                             .up = "z",
                             .front = "x",
                             .mount = {mount.x(), mount.y(), mount.z()}}};
  WriteText(folder / "straight.obj", ToObj(RawLever()));
  const PartDraft straight = Load(ReadOne(folder / "straight.obj", config), PartRole::kHandle);
  for (const double angle : {0.3, 1.1, 2.5}) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angle, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
    TriangleMesh lever = RawLever();
    for (Eigen::Vector3d& v : lever.vertices) v = turn * v;
    WriteText(folder / "skew.obj", ToObj(lever));
    // of "up" counts what is square to "front"; the length of both does not
    const Eigen::Vector3d front = turn.col(0);
    const Eigen::Vector3d up = 3 * turn.col(2) + turn.col(0);
    const Eigen::Vector3d skew_mount = turn * mount;
    config.mesh.front = Direction(1000 * front);
    config.mesh.up = Direction(1000 * up);
    config.mesh.mount = {skew_mount.x(), skew_mount.y(), skew_mount.z()};
    const PartDraft skew = Load(ReadOne(folder / "skew.obj", config), PartRole::kHandle);
    ExpectNear(skew.facts.joint.origin_m, straight.facts.joint.origin_m, 1e-6);
    ExpectNear(skew.facts.joint.axis, straight.facts.joint.axis, 1e-6);
    ASSERT_EQ(skew.pieces.size(), straight.pieces.size());
    const std::vector<Eigen::Vector3d>& vertices = skew.pieces[0].mesh.vertices;
    const std::vector<Eigen::Vector3d>& expected = straight.pieces[0].mesh.vertices;
    EXPECT_EQ(vertices.size(), expected.size());
    EXPECT_LT(FarthestFrom(expected, vertices), 1e-6);
    EXPECT_LT(FarthestFrom(vertices, expected), 1e-6);
    // its length is the one that it has in the part, not that of a box along the file's axes
    config.mesh.unit = "";
    config.mesh.mount = {};
    config.mesh.size_m = 0.26;
    ExpectNear(
        BoundsOf(Load(ReadOne(folder / "skew.obj", config), PartRole::kHandle), "grip").sizes(),
        {0.26, 0.11, 0.036}, 1e-6);
    config.mesh.size_m = 0;
    config.mesh.unit = "m";
  }
  for (const auto& [front, up] :
       std::vector<std::pair<std::string, std::string>>{{"1,0", "z"},
                                                        {"0,0,0", "z"},
                                                        {"1,2,3,4", "z"},
                                                        {"1,nan,0", "z"},
                                                        {"a,b,c", "z"},
                                                        {"1,,0", "z"},
                                                        {"0,0.01,1", "z"},
                                                        {"x", "1,0.01,0"}}) {
    config.mesh.front = front;
    config.mesh.up = up;
    ExpectError(folder / "skew.obj", ErrorCode::kInvalidArgument, front == "x" ? "up" : "front",
                config);
  }
}

TEST(LooseMesh, TheUnitIsToldByTheSizeOrAskedFor) {
  const fs::path folder = TestFolder("mesh_unit");
  ReadConfig config{.category = "storagefurniture", .mesh = {.role = "handle"}};
  const auto read = [&](double length) {
    WriteText(folder / "bar.obj", ToObj(Box(length * Eigen::Vector3d(0, -0.05, -0.5),
                                            length * Eigen::Vector3d(0.2, 0.05, 0.5))));
    return ReadOne(folder / "bar.obj", config);
  };
  // length in the file's unit -> metres a unit
  for (const auto& [length, scale] : std::map<double, double>{
           {0.14, 1}, {0.6, 1}, {14, 0.01}, {140, 0.001}, {590, 0.001}, {1.3, 1}})
    EXPECT_EQ(read(length).scale, scale) << length;
  // an OBJ says nothing, and its unit needs no word
  ASSERT_EQ(read(0.14).notes.size(), 1U);
  EXPECT_NE(read(0.14).notes.at(0).find("axes assumed"), std::string::npos);
  EXPECT_NE(read(140).notes.at(0).find("read in mm"), std::string::npos);
  EXPECT_NE(read(1.3).notes.at(0).find("--size"), std::string::npos);
  // 0.4 m or 40 mm
  EXPECT_THROW(read(40), Error);
  // no handle in any unit, and no thing that a door could carry
  EXPECT_THROW(read(1900), Error);
  config.mesh.unit = "mm";
  EXPECT_EQ(read(40).scale, 0.001);
  config.mesh = {.role = "handle", .size_m = 0.2};
  ExpectNear(BoundsOf(Load(read(40), PartRole::kHandle), "grip").sizes(), {0.04, 0.02, 0.2}, 1e-9);
  config.mesh.unit = "mm";
  EXPECT_THROW(read(40), Error);
  // the same number is a leaf's height in mm
  WriteText(folder / "leaf.obj", ToObj(Box({0, -380, -950}, {38, 380, 950})));
  config.mesh = {.role = "body"};
  EXPECT_EQ(ReadOne(folder / "leaf.obj", config).scale, 0.001);
}

TEST(LooseMesh, OnlyAxesThatWereNotNamedAreSaidToBeAssumed) {
  const fs::path folder = TestFolder("mesh_assumed");
  WriteText(folder / "bar.obj", ToObj(Box({0, -0.01, -0.07}, {0.03, 0.01, 0.07})));
  ReadConfig config{.category = "storagefurniture", .mesh = {.role = "handle"}};
  const auto notes = [&](const std::string& front, const std::string& up) {
    config.mesh.front = front;
    config.mesh.up = up;
    return ReadOne(folder / "bar.obj", config).notes;
  };
  const std::string assumed = "axes assumed, for the file states none: ";
  EXPECT_EQ(notes("", ""),
            std::vector{assumed + "z up, x out of the door; --up and --front say otherwise"});
  EXPECT_EQ(notes("x", ""), std::vector{assumed + "z up; --up says otherwise"});
  EXPECT_EQ(notes("", "z"), std::vector{assumed + "x out of the door; --front says otherwise"});
  EXPECT_TRUE(notes("x", "z").empty());
}

TEST(LooseMesh, ALeafIsHingedAtItsEdgeAndABoxIsRefused) {
  const fs::path folder = TestFolder("mesh_leaf");
  WriteText(folder / "31.obj", ToObj(Box({-0.01, 0, 0}, {0, 0.25, 0.25})));
  ReadConfig config{.category = "storagefurniture"};
  config.mesh = {.role = "body", .scale = {1, 2, 4}};
  const ForeignObject left = ReadOne(folder / "31.obj", config);
  const PartDraft body = Load(left, PartRole::kBody);
  EXPECT_EQ(body.facts.id, "mesh_leaf-31");
  ExpectNear(BoundsOf(body, "leaf").sizes(), {0.01, 0.5, 1}, 1e-6);
  ExpectNear(body.facts.joint.origin_m, {-0.005, 0, 0}, 1e-6);
  config.mesh.hinge = "right";
  const ForeignObject right = ReadOne(folder / "31.obj", config);
  EXPECT_TRUE(right.mirrored);
  ExpectNear(Load(right, PartRole::kBody).facts.joint.origin_m, {-0.005, -0.5, 0}, 1e-6);
  WriteText(folder / "drawer.obj", ToObj(Box({-0.58, 0, 0}, {0, 0.25, 0.25})));
  config.mesh.scale = {};
  const std::vector<ForeignObject> drawer = ReadAll(folder / "drawer.obj", config);
  EXPECT_NE(drawer.at(0).refusal.find("deep"), std::string::npos);
}

TEST(FindObjects, EachFolderGoesToTheFormatThatKnowsIt) {
  const fs::path root = TestFolder("find_formats");
  WriteSmallCabinet(root / "a/1");
  WriteSmallCabinet(root / "a/2");
  WriteText(root / "a/2/mobility_annotation_gapartnet.urdf", "x");
  WriteSmallObject(root / "b/LeverDoor/99650069960003");
  WriteText(root / "c/motion_unity.urdf", "x");
  WriteText(root / "d/one.urdf", "x");
  WriteText(root / "e/loose.obj", "x");
  std::string formats;
  for (const ForeignSource& source : FindObjects(root)) formats += source.format + " ";
  EXPECT_EQ(formats, "partnet-mobility gapartnet unidoormanip akb48 urdf ");
  EXPECT_EQ(FindObjects(root / "e/loose.obj").at(0).format, "mesh");
  EXPECT_EQ(FindObjects(root / "e", "mesh").size(), 1U);
  EXPECT_EQ(FindObjects(root, "gapartnet").size(), 1U);
  EXPECT_THROW(FindObjects(root / "e"), Error);
  EXPECT_THROW(FindObjects(root / "nowhere"), Error);
  EXPECT_THROW(FindObjects(root, "blender"), Error);
}

}  // namespace
}  // namespace doorforge
