// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <functional>

#include <gtest/gtest.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/mesh_file.h"
#include "doorforge/schemas/part.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

TriangleMesh Tetrahedron(double size) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

Part LeverPart() {
  Part part;
  part.id = "test-lever";
  part.role = PartRole::kHandle;
  part.mechanism = Mechanism::kLever;
  part.license = "CC0-1.0";
  part.source = "test";
  part.joint.axis = {1, 0, 0};
  part.joint.upper_rad = 0.785;
  part.part_from_grasp = FromXyzRpy({0.05, -0.06, 0}, {0, -1.5707963267948966, 0});
  part.grasp_half_extent_m = {0.01, 0.02, 0.01};
  PartPiece grip;
  grip.name = "grip";
  grip.mesh = Tetrahedron(0.1);
  grip.hulls = {Tetrahedron(0.1), Tetrahedron(0.05)};
  grip.mass.mass_kg = 0.4;
  grip.mass.inertia_kg_m2 << 1, 0.1, 0.2, 0.1, 2, 0.3, 0.2, 0.3, 2.5;
  part.pieces.push_back(grip);
  return part;
}

DoorAsset TestDoor() {
  DoorAsset door;
  door.id = "test-door";
  door.body.id = "test-body";
  door.handle.id = "test-lever";
  door.mechanism = Mechanism::kLever;
  door.license = "CC0-1.0";
  const char* names[] = {"base", "leaf", "handle"};
  for (std::size_t i = 0; i < 3; ++i) {
    door.links[i].name = names[i];
    DoorGeometry geometry;
    geometry.name = std::string(names[i]) + "_mesh";
    geometry.mesh = Tetrahedron(0.1 * static_cast<double>(i + 1));
    geometry.hulls = {geometry.mesh};
    geometry.label = i == 2 ? PointLabel::kHandle : PointLabel::kFrame;
    door.links[i].geometry.push_back(geometry);
    door.links[i].mass.mass_kg = 1;
  }
  door.hinge = {"hinge", Translation({0, -0.4, 0}), {0, 0, -1}, 0, 1.5, 100, 2, 0.5};
  door.handle_joint = {
      "handle_joint", Translation({0.02, 0.7, 0.9}), {1, 0, 0}, 0, 0.785, 10, 5, 0};
  door.latch.type = LatchType::kEffort;
  door.latch.unlock_angle_rad = 0.5;
  return door;
}

class Records : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(Records, APartReadsBackWithTheSameContent) {
  const Part part = LeverPart();
  WritePart(part, folder_);
  const Part again = ReadPart(folder_);
  EXPECT_EQ(again.id, part.id);
  EXPECT_EQ(again.mechanism, Mechanism::kLever);
  ASSERT_EQ(again.pieces.size(), 1U);
  EXPECT_EQ(again.pieces[0].hulls.size(), 2U);
  EXPECT_TRUE(again.pieces[0].mass.inertia_kg_m2.isApprox(part.pieces[0].mass.inertia_kg_m2));
  EXPECT_TRUE(again.part_from_grasp.isApprox(part.part_from_grasp, 1e-12));
  EXPECT_EQ(ShapeOf(again), ShapeOf(part));
  EXPECT_EQ(ContentHash(again), ContentHash(part));
}

TEST_F(Records, TheHashOfAPartSeesOneMovedVertex) {
  Part part = LeverPart();
  const std::string before = ContentHash(part);
  part.pieces[0].hulls[1].vertices[0].x() += 1e-3;
  EXPECT_NE(ContentHash(part), before);
}

TEST_F(Records, ADoorReadsBackWithTheSameContent) {
  const DoorAsset door = TestDoor();
  WriteDoor(door, folder_);
  const DoorAsset again = ReadDoor(folder_);
  EXPECT_EQ(ContentHash(again), ContentHash(door));
  EXPECT_EQ(again.links[kHandleLink].geometry[0].label, PointLabel::kHandle);
  EXPECT_EQ(again.hinge.velocity_limit_rad_s, 2);
}

TEST_F(Records, AMeshPathThatLeavesTheFolderIsRefused) {
  WriteDoor(TestDoor(), folder_ / "door");
  CommitFile(folder_ / "secret.obj", ToObj(Tetrahedron(1)));
  fs::create_symlink(folder_ / "secret.obj", folder_ / "door/link.obj");
  const std::vector<std::string> escapes = {"../secret.obj", "meshes/../../secret.obj",
                                            (folder_ / "secret.obj").string(), "link.obj"};
  for (const std::string& path : escapes) {
    auto json = ReadJsonFile(folder_ / "door/door.json");
    json["links"][0]["geometry"][0]["mesh"]["path"] = path;
    WriteJsonFile(folder_ / "door/door.json", json);
    try {
      ReadDoor(folder_ / "door");
      FAIL() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFormat);
      EXPECT_NE(std::string(error.what()).find("leaves the folder"), std::string::npos);
    }
  }
}

// Every mesh below `folder`, with one digit of its first coordinate another one: still a mesh, and
// not the recorded one.
void ExpectEveryChangedMeshIsRefused(const fs::path& folder, const std::function<void()>& read) {
  std::vector<fs::path> meshes;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".obj") meshes.push_back(entry.path());
  }
  ASSERT_GE(meshes.size(), 2U);
  for (const fs::path& mesh : meshes) {
    const std::string text = ReadFile(mesh);
    std::string changed = text;
    changed.at(text.find_first_of("0123456789")) ^= 1;
    CommitFile(mesh, changed);
    EXPECT_NO_THROW(ReadObj(mesh));
    try {
      read();
      ADD_FAILURE() << mesh << " was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFormat);
      EXPECT_NE(std::string(error.what()).find(mesh.string() + ": SHA-256 "), std::string::npos)
          << error.what();
    }
    CommitFile(mesh, text);
  }
  EXPECT_NO_THROW(read());
}

TEST_F(Records, AChangedMeshOfADoorIsRefusedByName) {
  WriteDoor(TestDoor(), folder_);
  ExpectEveryChangedMeshIsRefused(folder_, [&] { ReadDoor(folder_); });
}

TEST_F(Records, AChangedMeshOfAPartIsRefusedByName) {
  WritePart(LeverPart(), folder_);
  ExpectEveryChangedMeshIsRefused(folder_, [&] { ReadPart(folder_); });
}

// Pieces lend their names to files, and a grip that is there four hundred times costs minutes.
TEST_F(Records, TwoPiecesOfOneNameAreRefusedByName) {
  const auto refusal = [&](const std::function<void()>& read) -> std::string {
    try {
      read();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFormat);
      return error.what();
    }
    return "";
  };
  WritePart(LeverPart(), folder_);
  auto part = ReadJsonFile(folder_ / "part.json");
  part["pieces"].push_back(part["pieces"].back());
  WriteJsonFile(folder_ / "part.json", part);
  const std::string name = part["pieces"].back()["name"].get<std::string>();
  const std::string of_part = refusal([&] { ReadPart(folder_); });
  EXPECT_NE(of_part.find("part.json"), std::string::npos) << of_part;
  EXPECT_NE(of_part.find('"' + name + '"'), std::string::npos) << of_part;
}

TEST_F(Records, ADoorWithTwoPiecesOfOneNameIsReadAndNotSimulated) {
  DoorAsset door = TestDoor();
  EXPECT_NO_THROW(RequireSimulatable(door, "test"));
  door.links[kLeafLink].geometry.push_back(door.links[kHandleLink].geometry.at(0));
  try {
    RequireSimulatable(door, "test");
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("two pieces"), std::string::npos) << error.what();
  }
}

TEST_F(Records, ANewerSchemaVersionIsRefused) {
  WritePart(LeverPart(), folder_);
  auto json = ReadJsonFile(folder_ / "part.json");
  json["schema_version"] = kPartSchemaVersion + 1;
  WriteJsonFile(folder_ / "part.json", json);
  EXPECT_THROW(ReadPart(folder_), Error);
}

// With the hinge at y = -0.4 the free edge swings towards x > 0 (design, section 3).
TEST(DoorFromLinks, PositiveAnglesOpenTowardsXAndTurnTheLeverTipDown) {
  const DoorAsset door = TestDoor();
  const auto quarter = DoorFromLinks(door, 1.5707963267948966, 0);
  const Eigen::Vector3d free_edge = quarter[kLeafLink] * Eigen::Vector3d(0, 0.8, 0);
  EXPECT_TRUE(free_edge.isApprox(Eigen::Vector3d(0.8, -0.4, 0), 1e-9)) << free_edge.transpose();
  const auto turned = DoorFromLinks(door, 0, 0.5);
  const Eigen::Vector3d tip = turned[kHandleLink] * Eigen::Vector3d(0, -0.1, 0);
  EXPECT_LT(tip.z(), 0.9) << "the tip of a lever that points to the hinge goes down";
}

TEST(MeshFile, TextReadsBackToTheSameText) {
  TriangleMesh mesh = Tetrahedron(0.1);
  mesh.vertices[1] = {1.0 / 3, -0.0, 1e-7};
  const std::string text = ToObj(mesh);
  const fs::path path = fs::path(testing::TempDir()) / "mesh_file_test.obj";
  CommitFile(path, text);
  EXPECT_EQ(ToObj(ReadObj(path)), text);
  EXPECT_EQ(text.find("-0 "), std::string::npos);
}

TEST(MeshFile, RefusesAVertexBeyondAHundredMetres) {
  EXPECT_EQ(ParseObj("v 100 -100 100\n", "a.obj").vertices.size(), 1U);
  for (const char* const far : {"v 100.01 0 0\n", "v 0 -343598 0\n", "v 0 0 3e38\n"}) {
    try {
      ParseObj("v 0 0 0\n" + std::string(far), "a.obj");
      ADD_FAILURE() << far;
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(error.code(), ErrorCode::kFormat);
      EXPECT_NE(message.find("a.obj:2: a vertex at ("), std::string::npos) << message;
      EXPECT_NE(message.find("up to 100 m"), std::string::npos) << message;
    }
  }
}

TEST(MeshFile, RefusesWhatItWouldNotWrite) {
  const fs::path path = fs::path(testing::TempDir()) / "mesh_file_bad.obj";
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const std::string bad : {"f 1 2 4\n", "f 0 1 2\n", "f 1/1 2/2 3/3\n", "f 1 2 3 4\n",
                                "v 1 2\n", "v nan 0 0\n", "vn 0 0 1\n"}) {
    CommitFile(path, three + bad);
    try {
      ReadObj(path);
      FAIL() << bad;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(":4:"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace doorforge
