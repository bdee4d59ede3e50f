// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/visual_mesh.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/part.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

const std::string kPng("\x89PNG\r\n\x1a\n and pixels", 19);
const std::string kJpeg("\xff\xd8\xff and pixels", 14);

// Two triangles with a picture, one without texture coordinates.
VisualMesh TwoSurfaces() {
  VisualMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.2, 0}, {0, 0.2, 0}};
  mesh.texcoords = {{0, 0}, {1, 0}, {1, 0.25}, {-2.5, 0.75}};
  mesh.surfaces = {{{"wood", {1, 1, 1, 1}, MakeVisualTexture(kPng)},
                    {{0, 1, 2}, {0, 2, 3}},
                    {{0, 1, 2}, {0, 2, 3}}},
                   {{"glass", {0.25, 0.5, 0.75, 0.5}, nullptr}, {{2, 1, 0}}, {}}};
  return mesh;
}

Part PartWith(const VisualMesh& visual) {
  Part part;
  part.id = "drawn";
  part.license = "CC0-1.0";
  PartPiece leaf;
  leaf.name = "leaf";
  leaf.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  leaf.mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  leaf.hulls = {leaf.mesh};
  leaf.visual = visual;
  part.pieces.push_back(leaf);
  return part;
}

DoorAsset DoorWith(const VisualMesh& visual) {
  DoorAsset door;
  door.id = "drawn";
  door.body.id = "drawn-body";
  door.handle.id = "drawn-handle";
  for (std::size_t i = 0; i < 3; ++i) door.links[i].name = std::to_string(i);
  const PartPiece leaf = PartWith(visual).pieces[0];
  door.links[kLeafLink].geometry.push_back({.name = "leaf",
                                            .mesh = leaf.mesh,
                                            .hulls = leaf.hulls,
                                            .color_rgba = leaf.color_rgba,
                                            .label = PointLabel::kBody,
                                            .visual = visual});
  return door;
}

class VisualMeshFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // what ReadPart() says, without the folder; "" where it reads
  std::string Problem() const {
    try {
      ReadPart(folder_ / "part");
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  void Patch(const std::function<void(nlohmann::ordered_json&)>& patch) const {
    auto json = ReadJsonFile(folder_ / "part/part.json");
    patch(json["pieces"][0]["visual"]);
    WriteJsonFile(folder_ / "part/part.json", json);
  }

  fs::path folder_;
};

TEST_F(VisualMeshFiles, APartReadsBackWithMaterialsTexcoordsAndPictures) {
  const Part part = PartWith(TwoSurfaces());
  WritePart(part, folder_);
  const Part again = ReadPart(folder_);
  EXPECT_EQ(ContentHash(again), ContentHash(part));
  const VisualMesh& visual = again.pieces[0].visual;
  ASSERT_EQ(visual.surfaces.size(), 2U);
  EXPECT_EQ(visual.surfaces[0].material.name, "wood");
  ASSERT_NE(visual.surfaces[0].material.texture, nullptr);
  EXPECT_EQ(visual.surfaces[0].material.texture->bytes, kPng);
  EXPECT_EQ(visual.surfaces[0].texcoords, TwoSurfaces().surfaces[0].texcoords);
  EXPECT_EQ(visual.texcoords, TwoSurfaces().texcoords);
  EXPECT_EQ(visual.surfaces[1].material.color_rgba, Eigen::Vector4d(0.25, 0.5, 0.75, 0.5));
  EXPECT_TRUE(visual.surfaces[1].texcoords.empty());
}

TEST_F(VisualMeshFiles, ADoorReadsBackWithTheSameContent) {
  const DoorAsset door = DoorWith(TwoSurfaces());
  WriteDoor(door, folder_);
  EXPECT_EQ(ContentHash(ReadDoor(folder_)), ContentHash(door));
  EXPECT_TRUE(fs::exists(folder_ / AuthoredMeshPath(door.links[kLeafLink].geometry[0])));
}

TEST_F(VisualMeshFiles, RecordsWithoutAVisualMeshSayNothingOfIt) {
  WritePart(PartWith({}), folder_);
  EXPECT_EQ(ReadFile(folder_ / "part.json").find("visual"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "meshes/authored"));
  EXPECT_TRUE(ReadPart(folder_).pieces[0].visual.empty());
}

TEST_F(VisualMeshFiles, TheHashSeesColoursTexcoordsAndPictures) {
  const std::string before = ContentHash(PartWith(TwoSurfaces()));
  VisualMesh other = TwoSurfaces();
  other.surfaces[1].material.color_rgba[0] += 0.01;
  EXPECT_NE(ContentHash(PartWith(other)), before);
  other = TwoSurfaces();
  other.texcoords[2].x() += 0.01;
  EXPECT_NE(ContentHash(PartWith(other)), before);
  other = TwoSurfaces();
  other.surfaces[0].material.texture = MakeVisualTexture(kJpeg);
  EXPECT_NE(ContentHash(PartWith(other)), before);
  EXPECT_NE(ContentHash(PartWith({})), before);
  EXPECT_EQ(ContentHash(PartWith(TwoSurfaces())), before);
}

TEST_F(VisualMeshFiles, NamesFollowFromContent) {
  const VisualFiles files = VisualFilesIn("a", "leaf", TwoSurfaces());
  EXPECT_EQ(files.mesh.path, "a/leaf.obj");
  EXPECT_EQ(files.materials.path, "a/" + files.materials.sha256.substr(0, 20) + ".mtl");
  ASSERT_EQ(files.textures.size(), 1U);
  EXPECT_EQ(files.textures[0].path, "a/" + files.textures[0].sha256.substr(0, 20) + ".png");
  const VisualTexts texts = ToTexts(TwoSurfaces());
  EXPECT_TRUE(texts.mesh.starts_with("mtllib " + MaterialFileName(texts.materials) + "\n"));
  EXPECT_EQ(texts.materials, "newmtl wood\nKd 1 1 1\nd 1\nmap_Kd " +
                                 files.textures[0].path.substr(2) +
                                 "\nnewmtl glass\nKd 0.25 0.5 0.75\nd 0.5\n");
}

TEST_F(VisualMeshFiles, FaultsAreRefusedWithTheirPlace) {
  const VisualFiles files = VisualFilesIn("meshes/authored", "leaf", TwoSurfaces());
  const auto damaged = [&](const RecordedFile& file, const std::string& what,
                           const std::string& with) {
    const VisualTexts texts = ToTexts(TwoSurfaces());
    std::string text = file.path.ends_with(".obj") ? texts.mesh : texts.materials;
    text.replace(text.find(what), what.size(), with);
    try {
      ReadVisualMesh(files, [&](const RecordedFile& wanted) {
        if (wanted.path == file.path) return text;
        if (wanted.path.ends_with(".png")) return kPng;
        return wanted.path.ends_with(".obj") ? texts.mesh : texts.materials;
      });
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFormat);
      return std::string(error.what());
    }
    return std::string();
  };
  const auto has = [](const std::string& message, const std::string& part) {
    return message.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(damaged(files.mesh, "f 3 2 1", "f 3 2 5"), "leaf.obj:14: index 5 is out of"));
  EXPECT_TRUE(has(damaged(files.mesh, "f 1/1", "f 1/9"), "index 9 is out of range"));
  EXPECT_TRUE(has(damaged(files.mesh, "f 1/1", "f 1"), "some corners alone"));
  EXPECT_TRUE(has(damaged(files.mesh, "usemtl glass", "usemtl gold"), "unknown material \"gold\""));
  EXPECT_TRUE(has(damaged(files.mesh, "v 0 0 0", "v 0 nan 0"), ":2: expected 3 finite numbers"));
  EXPECT_TRUE(has(damaged(files.mesh, "v 0 0 0", "v 0 2000 0"), ":2: a vertex at (0, 2000, 0) m"));
  EXPECT_TRUE(has(damaged(files.materials, "Kd 1 1 1", "Kd 1 2 1"), "not within 0 and 1"));
  EXPECT_TRUE(has(damaged(files.materials, "map_Kd ", "map_Kd ../../"), "names no texture"));
}

TEST_F(VisualMeshFiles, MissingChangedAndEscapingFilesAreRefused) {
  WritePart(PartWith(TwoSurfaces()), folder_ / "part");
  const VisualFiles files = VisualFilesIn("meshes/authored", "leaf", TwoSurfaces());
  const fs::path picture = folder_ / "part" / files.textures[0].path;
  EXPECT_EQ(Problem(), "");
  fs::rename(picture, folder_ / "picture.png");
  EXPECT_NE(Problem().find(picture.filename().string()), std::string::npos);
  CommitFile(picture, kJpeg);
  EXPECT_NE(Problem().find("SHA-256"), std::string::npos);
  fs::remove(picture);
  fs::create_symlink(folder_ / "picture.png", picture);
  EXPECT_NE(Problem().find("leaves the folder"), std::string::npos);
  Patch([](auto& visual) { visual["textures"][0]["path"] = "../picture.png"; });
  EXPECT_NE(Problem().find("leaves the folder"), std::string::npos);
  Patch([](auto& visual) { visual["path"] = "/etc/passwd"; });
  EXPECT_NE(Problem().find("leaves the folder"), std::string::npos);
}

TEST(VisualMesh, WhatFilesCannotHoldIsRefused) {
  EXPECT_THROW(MakeVisualTexture("GIF89a"), Error);
  const auto refused = [](const std::function<void(VisualMesh&)>& change) {
    VisualMesh mesh = TwoSurfaces();
    change(mesh);
    EXPECT_THROW(ToTexts(mesh), Error);
  };
  refused([](VisualMesh& mesh) { mesh.surfaces[0].triangles[0][1] = 4; });
  refused([](VisualMesh& mesh) { mesh.surfaces[0].texcoords[0][1] = -1; });
  refused([](VisualMesh& mesh) { mesh.surfaces[0].texcoords.pop_back(); });
  refused([](VisualMesh& mesh) { mesh.surfaces[0].material.name = "two words"; });
  refused([](VisualMesh& mesh) { mesh.surfaces[0].material.name = "glass"; });
}

}  // namespace
}  // namespace doorforge
