// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "formats/import_unidoormanip.h"

#include <numbers>

#include <gtest/gtest.h>

#include "doorforge/core/error.h"

#include "small_object.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

Eigen::AlignedBox3d BoxAround(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  return box;
}

const RawPiece& PieceNamed(const PartDraft& draft, const std::string& name) {
  for (const RawPiece& piece : draft.pieces) {
    if (piece.name == name) return piece;
  }
  throw std::runtime_error("no piece " + name);
}

// an error of this code whose message holds `part`
void ExpectRefused(const fs::path& folder, ErrorCode code, const std::string& part,
                   const std::string& category = "") {
  try {
    ReadUniDoorManip(folder, category);
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

struct Fixture {
  explicit Fixture(const std::string& test, const SmallObject& object = {})
      : folder(TestFolder(test) / "LeverDoor/99650069960003") {
    WriteSmallObject(folder, object);
  }
  fs::path folder;
};

TEST(ImportUniDoorManip, TurnsRawMeshesIntoThePartFrame) {
  const Fixture fixture("frames");
  const UniDoorManipObject object = ReadUniDoorManip(fixture.folder, "");
  const PartDraft body = LoadBody(object);
  // raw (x, y, z) -> ours (-y, x, z), scaled by 0.8, then lifted by 0.8
  const Eigen::AlignedBox3d leaf = BoxAround(PieceNamed(body, "leaf").mesh);
  ExpectNear(leaf.min(), {-0.02, -0.4, 0}, 1e-6);
  ExpectNear(leaf.max(), {0.02, 0.4, 1.6}, 1e-6);
  const Eigen::AlignedBox3d frame = BoxAround(PieceNamed(body, "frame").mesh);
  ExpectNear(frame.max(), {0.04, 0.448, 1.648}, 1e-6);
  const PartDraft handle = LoadHandle(object);
  const Eigen::AlignedBox3d grip = BoxAround(PieceNamed(handle, "grip").mesh);
  ExpectNear(grip.min(), {0, -0.15, -0.01125}, 1e-6);
  ExpectNear(grip.max(), {0.06875, 0.0125, 0.01125}, 1e-6);
}

TEST(ImportUniDoorManip, PutsHingeMountAndGraspWhereTheTablesOfTheReleaseSay) {
  const Fixture fixture("joints");
  const UniDoorManipObject object = ReadUniDoorManip(fixture.folder, "");
  const Part body = LoadBody(object).facts;
  ExpectNear(body.joint.origin_m, {0, -0.4, 1.6}, 1e-6);
  ExpectNear(body.joint.axis, {0, 0, -1}, 1e-9);
  EXPECT_NEAR(body.joint.upper_rad, 86.4 * std::numbers::pi / 180, 1e-9);
  // 8 cm from the free edge, 0.8 m above the leaf's bottom, on its front
  ExpectNear(body.part_from_mount.translation(), {0.02, 0.32, 0.8}, 1e-6);
  const Part handle = LoadHandle(object).facts;
  ExpectNear(handle.joint.axis, {1, 0, 0}, 1e-9);
  EXPECT_NEAR(handle.joint.upper_rad, std::numbers::pi / 4, 1e-12);  // not the file's 86.4 degrees
  ExpectNear(handle.part_from_grasp.translation(), {0.059375, -0.075, 0}, 1e-6);
  ExpectNear(handle.part_from_grasp.linear() * Eigen::Vector3d::UnitZ(), {-1, 0, 0}, 1e-12);
  ExpectNear(handle.part_from_grasp.linear() * Eigen::Vector3d::UnitY(), {0, 0, 1}, 1e-12);
}

TEST(ImportUniDoorManip, AgreesWithTheBoxesThatTheObjectStates) {
  const Fixture fixture("boxes");
  UniDoorManipObject object = ReadUniDoorManip(fixture.folder, "");
  EXPECT_LT(BoxDeviation(object, LoadBody(object)), 1e-6);
  EXPECT_LT(BoxDeviation(object, LoadHandle(object)), 1e-6);
  object.body_box.translate(Eigen::Vector3d(0, 0.03, 0));
  EXPECT_NEAR(BoxDeviation(object, LoadBody(object)), 0.03, 1e-6);
}

TEST(ImportUniDoorManip, TakesTheAxisTheOtherWayRoundWhenTheLimitsAreNegative) {
  const Fixture fixture("negative_limits");
  std::string urdf = SmallUrdf({});
  urdf.replace(urdf.find("axis xyz=\"0 -1 0\""), 17, "axis xyz=\"0 2 0\" ");
  urdf.replace(urdf.find("lower=\"0\" upper=\"1.5"), 20, "lower=\"-1.5\" upper=\"0\"");
  urdf.replace(urdf.find("upper=\"0\"079"), 12, "upper=\"0\"");
  urdf.replace(urdf.find("644737231006\""), 13, "");
  WriteText(fixture.folder / "mobility.urdf", urdf);
  const Part body = LoadBody(ReadUniDoorManip(fixture.folder, "")).facts;
  ExpectNear(body.joint.axis, {0, 0, -1}, 1e-9);
  EXPECT_DOUBLE_EQ(body.joint.lower_rad, 0);
  EXPECT_DOUBLE_EQ(body.joint.upper_rad, 1.5);
}

TEST(ImportUniDoorManip, TellsTheCategoryByFolderArgumentOrContent) {
  const fs::path root = TestFolder("categories");
  const auto read = [&](const std::string& place, const std::string& category) {
    WriteSmallObject(root / place);
    return ReadUniDoorManip(root / place, category);
  };
  EXPECT_EQ(read("LeverDoor/a", "").mechanism, Mechanism::kLever);
  EXPECT_EQ(read("RoundDoor/a", "").mechanism, Mechanism::kRound);
  EXPECT_EQ(read("Cabinet/a", "").category, Category::kStorageFurniture);
  EXPECT_EQ(read("Cabinet/a", "").mechanism, Mechanism::kRound);
  EXPECT_EQ(read("Fridge/a", "").category, Category::kRefrigerator);
  EXPECT_EQ(read("Fridge/a", "safe").category, Category::kSafe);
  EXPECT_EQ(read("elsewhere/99613029962004", "").category, Category::kStorageFurniture);
  EXPECT_EQ(read("elsewhere/99650069960003", "").category, Category::kInterior);
  WriteSmallObject(root / "elsewhere/mine");
  ExpectRefused(root / "elsewhere/mine", ErrorCode::kInvalidArgument, "--category");
  ExpectRefused(root / "elsewhere/mine", ErrorCode::kInvalidArgument, "gate", "gate");
}

TEST(ImportUniDoorManip, NamesEveryMissingMesh) {
  const Fixture fixture("missing");
  fs::remove(fixture.folder / "texture_dae/frame.obj");
  fs::remove(fixture.folder / "texture_dae/9960003.obj");
  ExpectRefused(fixture.folder, ErrorCode::kMissing, "texture_dae/frame.obj");
  ExpectRefused(fixture.folder, ErrorCode::kMissing, "texture_dae/9960003.obj");
  fs::remove(fixture.folder / "handle_bounding.json");
  ExpectRefused(fixture.folder, ErrorCode::kMissing, "handle_bounding.json");
  ExpectRefused(fixture.folder / "nowhere", ErrorCode::kMissing, "nowhere");
}

TEST(ImportUniDoorManip, RefusesMeshPathsThatLeaveTheFolder) {
  const Fixture fixture("leaving");
  const fs::path outside = fixture.folder.parent_path() / "outside.obj";
  WriteText(outside, ToObj(RawFrame()));
  fs::create_symlink(outside, fixture.folder / "texture_dae/link.obj");
  fs::create_directory_symlink(fixture.folder.parent_path(), fixture.folder / "up");
  for (const std::string& name :
       {std::string("../outside.obj"), fs::absolute(outside).string(),
        std::string("texture_dae/../../outside.obj"), std::string("texture_dae/link.obj"),
        std::string("up/outside.obj"), "file://" + fs::absolute(outside).string()}) {
    SmallObject object;
    object.frame_file = name;
    WriteText(fixture.folder / "mobility.urdf", SmallUrdf(object));
    ExpectRefused(fixture.folder, ErrorCode::kFormat, "inside the object's folder");
  }
}

TEST(ImportUniDoorManip, RefusesHostileAndForeignFiles) {
  const Fixture fixture("hostile");
  const auto with_urdf = [&](const std::string& text) {
    WriteText(fixture.folder / "mobility.urdf", text);
  };
  with_urdf("");
  ExpectRefused(fixture.folder, ErrorCode::kFormat, "mobility.urdf");
  with_urdf("<!DOCTYPE r [<!ENTITY a \"b\">]>" + SmallUrdf({}));
  ExpectRefused(fixture.folder, ErrorCode::kFormat, "mobility.urdf");
  std::string deep;
  for (int i = 0; i < 5000; ++i) deep += "<robot>";
  with_urdf(deep);
  ExpectRefused(fixture.folder, ErrorCode::kFormat, "mobility.urdf");
  with_urdf(SmallUrdf({.extra = std::string(17 << 20, ' ')}));
  EXPECT_THROW(ReadUniDoorManip(fixture.folder, ""), Error);
  with_urdf(SmallUrdf({.hinge_type = "prismatic"}));
  ExpectRefused(fixture.folder, ErrorCode::kFormat, "joint_1");
  with_urdf(SmallUrdf({.hinge_type = "fixed"}));
  ExpectRefused(fixture.folder, ErrorCode::kFormat, "movable");
  std::string many;
  for (int i = 0; i < 100; ++i)
    many += "<link name=\"l" + std::to_string(i) + "\"><visual>" +
            MeshElement("texture_dae/board.obj", 1) + "</visual></link><joint name=\"j" +
            std::to_string(i) + "\" type=\"fixed\"><parent link=\"base\"/><child link=\"l" +
            std::to_string(i) + "\"/></joint>";
  with_urdf(SmallUrdf({.extra = many}));
  ExpectRefused(fixture.folder, ErrorCode::kFormat, "more than 64 meshes");
  with_urdf(SmallUrdf({}));
  WriteText(fixture.folder / "handle_bounding.json", "{\"goal_pos\": [0, 0]}");
  ExpectRefused(fixture.folder, ErrorCode::kFormat, "handle_bounding.json");
}

TEST(ImportUniDoorManip, SharedPartsHaveOneSourceHashAndOtherScalesAnother) {
  const fs::path root = TestFolder("hashes");
  WriteSmallObject(root / "LeverDoor/99650069960003");
  WriteSmallObject(root / "LeverDoor/99650069960004", {.handle_scale = 1.0});
  WriteSmallObject(root / "LeverDoor/99650079960003", {.body_scale = 0.9});
  const auto a = ReadUniDoorManip(root / "LeverDoor/99650069960003", "");
  const auto b = ReadUniDoorManip(root / "LeverDoor/99650069960004", "");
  const auto c = ReadUniDoorManip(root / "LeverDoor/99650079960003", "");
  EXPECT_EQ(BodySourceHash(a), BodySourceHash(b));
  EXPECT_NE(BodySourceHash(a), BodySourceHash(c));
  EXPECT_NE(HandleSourceHash(a), HandleSourceHash(b));
  EXPECT_EQ(HandleSourceHash(a), HandleSourceHash(c));
}

}  // namespace
}  // namespace doorforge
