// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <map>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doorforge/compose/compose.h"
#include "doorforge/compose/shared_doors.h"
#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/json_file.h"
#include "doorforge/exporters/export_door.h"
#include "doorforge/exporters/export_urdf.h"
#include "doorforge/importers/import_objects.h"
#include "doorforge/mesh/import_mesh.h"
#include "doorforge/schemas/door_identity.h"
#include "doorforge/validate/validate_door.h"

#include "mujoco_door.h"
#include "scratch_folder.h"

// What authors draw, from their OBJ through part, door, URDF and GLB. assimp and the bytes of the
// GLB are the second opinions.

namespace doorforge {
namespace {

namespace fs = std::filesystem;

// One red pixel.
const std::string kPng(
    "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x01\x00\x00"
    "\x00\x01\x08\x02\x00\x00\x00\x90\x77\x53\xde\x00\x00\x00\x0c\x49\x44\x41\x54\x78\x9c\x63"
    "\x38\x61\x64\x04\x00\x02\xf2\x01\x2d\xac\x6a\x27\xeb\x00\x00\x00\x00\x49\x45\x4e\x44\xae"
    "\x42\x60\x82",
    69);

/// A corner of a triangle: place and texture coordinates in micrometres and millionths.
using Corner = std::array<long, 5>;
using Corners = std::map<Corner, int>;

Corner CornerAt(const Eigen::Vector3d& p, const Eigen::Vector2d& at) {
  return {std::lround(p.x() * 1e5), std::lround(p.y() * 1e5), std::lround(p.z() * 1e5),
          std::lround(at.x() * 1e6), std::lround(at.y() * 1e6)};
}

// A box with its corner at `low`: faces across x in a picture, the others plain. Quadrilaterals are
// seen from outside; each has the picture once, the front of the box 1.5 times.
std::string BoxObj(const Eigen::Vector3d& low, const Eigen::Vector3d& size, bool open) {
  std::string text = "mtllib box.mtl\no box\n";
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d v = low + size.cwiseProduct(Eigen::Vector3d(i & 1, (i >> 1) & 1, i >> 2));
    text += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
            std::to_string(v.z()) + "\n";
  }
  text += "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 1.5 0\nvt 1.5 0.25\nvt 0 0.25\n";
  text += "usemtl oak wood\nf 2/1 4/5 8/6 6/7\nf 1/1 5/2 7/3 3/4\n";
  text += "usemtl edge\nf 1/1 2/2 6/3 5/4\nf 3/1 7/2 8/3 4/4\nf 1/1 3/2 4/3 2/4\n";
  return open ? text : text + "f 5/1 6/2 8/3 7/4\n";
}

const std::string kMaterials =
    "newmtl oak wood\nKd 1 1 1\nmap_Kd -s 1 1 1 grain.png\nnewmtl edge\nKd 0.2 0.4 0.6\nd 0.5\n";

constexpr double kLeaf[] = {0.04, 0.9, 2.0};
constexpr double kGrip[] = {0.04, 0.02, 0.15};

struct BoxFiles {
  std::string materials = kMaterials;
  std::string picture = kPng;
  bool open = false;
};

// parts "leaf" and "bar" below root/parts
ImportReport ImportBoxes(const fs::path& root, const BoxFiles& files = {},
                         ImportConfig config = {}) {
  fs::remove_all(root);
  CommitFile(root / "in/leaf.obj",
             BoxObj({-0.02, 0, 0}, Eigen::Map<const Eigen::Vector3d>(kLeaf), files.open));
  CommitFile(root / "in/bar.obj",
             BoxObj({0, -0.01, -0.075}, Eigen::Map<const Eigen::Vector3d>(kGrip), false));
  CommitFile(root / "in/box.mtl", files.materials);
  CommitFile(root / "in/grain.png", files.picture);
  config.read.category = "interior";
  config.read.mesh.unit = "m";
  config.read.mesh.up = "z";
  config.read.mesh.front = "x";
  config.threads = 1;
  config.read.mesh.role = "handle";
  const ImportReport bar =
      ImportObjects({{root / "in/bar.obj", "mesh"}}, root / "parts", config, Existing::kRefuse);
  EXPECT_EQ(bar.objects.at(0).message, "");
  config.read.mesh.role = "body";
  return ImportObjects({{root / "in/leaf.obj", "mesh"}}, root / "parts", config, Existing::kRefuse);
}

fs::path Folder(const std::string& name) { return ScratchFolder("visual") / name; }

Part Read(const fs::path& root, const std::string& id) { return ReadPart(root / "parts" / id); }

const DoorGeometry& LeafOf(const DoorAsset& door) { return door.links[kLeafLink].geometry.at(0); }

Corners CornersOf(const VisualMesh& mesh) {
  Corners corners;
  for (const VisualSurface& surface : mesh.surfaces) {
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      for (int k = 0; k < 3; ++k)
        ++corners[CornerAt(mesh.vertices.at(static_cast<std::size_t>(surface.triangles[i][k])),
                           mesh.texcoords.at(static_cast<std::size_t>(surface.texcoords[i][k])))];
    }
  }
  return corners;
}

double SignedVolume(const VisualMesh& mesh) {
  double volume = 0;
  for (const VisualSurface& surface : mesh.surfaces) {
    for (const Eigen::Vector3i& t : surface.triangles)
      volume += mesh.vertices[static_cast<std::size_t>(t[0])].dot(
                    mesh.vertices[static_cast<std::size_t>(t[1])].cross(
                        mesh.vertices[static_cast<std::size_t>(t[2])])) /
                6;
  }
  return volume;
}

// The author's file through assimp alone, moved so that its lowest corner is `low`.
Corners CornersOfFile(const fs::path& file, const Eigen::Vector3d* low) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate);
  EXPECT_NE(scene, nullptr) << importer.GetErrorString();
  if (scene == nullptr) return {};
  Eigen::AlignedBox3d bounds;
  const auto place = [](const aiVector3D& v) { return Eigen::Vector3d(v.x, v.y, v.z); };
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    for (unsigned i = 0; i < scene->mMeshes[m]->mNumVertices; ++i)
      bounds.extend(place(scene->mMeshes[m]->mVertices[i]));
  }
  const Eigen::Vector3d shift =
      low != nullptr ? Eigen::Vector3d(*low - bounds.min()) : Eigen::Vector3d::Zero();
  Corners corners;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned i = mesh.mFaces[f].mIndices[k];
        const aiVector3D& at = mesh.mTextureCoords[0][i];
        ++corners[CornerAt(place(mesh.mVertices[i]) + shift, {at.x, at.y})];
      }
    }
  }
  return corners;
}

Eigen::Vector3d LowCorner(const VisualMesh& mesh) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices) bounds.extend(vertex);
  return bounds.min();
}

// Corners with their places alone: assimp and we may split a face along different diagonals.
std::vector<Corner> Distinct(const Corners& corners) {
  std::vector<Corner> distinct;
  for (const auto& [corner, count] : corners) distinct.push_back(corner);
  return distinct;
}

TEST(VisualDoor, ImportKeepsTheAuthorsTrianglesMaterialsTexcoordsAndPictures) {
  const fs::path root = Folder("import");
  const ImportReport report = ImportBoxes(root);
  ASSERT_EQ(report.objects.at(0).message, "");
  EXPECT_TRUE(report.objects[0].notes.empty());
  const VisualMesh visual = FindPiece(Read(root, "leaf"), "leaf")->visual;
  ASSERT_EQ(visual.surfaces.size(), 2U);
  EXPECT_EQ(visual.surfaces[0].material.name, "oak_wood");
  EXPECT_EQ(visual.surfaces[0].material.color_rgba, Eigen::Vector4d(1, 1, 1, 1));
  ASSERT_NE(visual.surfaces[0].material.texture, nullptr);
  EXPECT_EQ(visual.surfaces[0].material.texture->bytes, kPng);
  EXPECT_EQ(visual.surfaces[1].material.name, "edge");
  EXPECT_LT((visual.surfaces[1].material.color_rgba - Eigen::Vector4d(0.2, 0.4, 0.6, 0.5)).norm(),
            1e-6);
  EXPECT_EQ(visual.surfaces[0].triangles.size() + visual.surfaces[1].triangles.size(), 12U);
  EXPECT_NEAR(SignedVolume(visual), 0.04 * 0.9 * 2, 1e-6);
  const Eigen::Vector3d low = LowCorner(visual);
  EXPECT_EQ(Distinct(CornersOf(visual)), Distinct(CornersOfFile(root / "in/leaf.obj", &low)));
  fs::remove_all(root);
}

TEST(VisualDoor, TheUrdfNamesAnObjThatAssimpReadsAlike) {
  const fs::path root = Folder("urdf");
  ImportBoxes(root);
  const DoorAsset door = ComposeDoor(Read(root, "leaf"), Read(root, "bar"), {});
  WriteDoorFolder(door, root / "door", Existing::kRefuse);
  EXPECT_EQ(ContentHash(ReadDoor(root / "door")), ContentHash(door));
  const UrdfShape shape = ReadUrdf(root / "door/model.urdf").links[kLeafLink].visuals.at(0);
  EXPECT_FALSE(shape.color_rgba) << "a material here would hide those of the mesh";
  const fs::path file = root / "door" / std::get<UrdfMeshFile>(shape.geometry).filename;
  EXPECT_EQ(CornersOfFile(file, nullptr), CornersOf(LeafOf(door).visual));
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  ASSERT_NE(scene, nullptr);
  aiString picture;
  int pictures = 0;
  for (unsigned i = 0; i < scene->mNumMaterials; ++i) {
    if (scene->mMaterials[i]->GetTexture(aiTextureType_DIFFUSE, 0, &picture) != aiReturn_SUCCESS)
      continue;
    ++pictures;
    EXPECT_EQ(ReadFile(file.parent_path() / picture.C_Str()), kPng);
  }
  EXPECT_EQ(pictures, 1);
  const ValidationReport report = ValidateDoor(root / "door", ValidationProfile::kUrdf);
  EXPECT_EQ(report.errors, 0) << (report.findings.empty() ? "" : report.findings[0].measured);
  fs::remove_all(root);
}

nlohmann::json JsonOfGlb(const std::string& glb) {
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  return nlohmann::json::parse(glb.substr(20, length));
}

/// Bytes of a GLB's buffer that a view or accessor names.
class GlbBytes {
 public:
  explicit GlbBytes(const std::string& glb) : json(JsonOfGlb(glb)) {
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    buffer_ = glb.substr(20 + length + 8);
  }

  std::string View(int view) const {
    const auto& entry = json["bufferViews"][static_cast<std::size_t>(view)];
    return buffer_.substr(entry.value("byteOffset", std::size_t{0}), entry["byteLength"]);
  }

  template <class Number>
  std::vector<Number> Numbers(int accessor) const {
    const std::string bytes =
        View(json["accessors"][static_cast<std::size_t>(accessor)]["bufferView"]);
    std::vector<Number> numbers(bytes.size() / sizeof(Number));
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return numbers;
  }

  nlohmann::json json;

 private:
  std::string buffer_;
};

TEST(VisualDoor, GlbCarriesMaterialsTexcoordsAndPictures) {
  const fs::path root = Folder("glb");
  ImportBoxes(root);
  const DoorAsset door = ComposeDoor(Read(root, "leaf"), Read(root, "bar"), {});
  const GlbBytes glb(ToGlb(door));
  const auto& meshes = glb.json["meshes"];
  const auto leaf = std::find_if(meshes.begin(), meshes.end(),
                                 [](const auto& mesh) { return mesh["name"] == "leaf"; });
  ASSERT_NE(leaf, meshes.end());
  Corners corners;
  std::vector<std::string> names;
  for (const auto& primitive : (*leaf)["primitives"]) {
    const auto places = glb.Numbers<float>(primitive["attributes"]["POSITION"]);
    const auto at = glb.Numbers<float>(primitive["attributes"]["TEXCOORD_0"]);
    for (const std::uint32_t i : glb.Numbers<std::uint32_t>(primitive["indices"]))
      ++corners[CornerAt({places.at(3 * i), places.at(3 * i + 1), places.at(3 * i + 2)},
                         {at.at(2 * i), 1 - at.at(2 * i + 1)})];
    names.push_back(glb.json["materials"][primitive["material"].get<std::size_t>()]["name"]);
  }
  EXPECT_EQ(corners, CornersOf(LeafOf(door).visual));
  EXPECT_EQ(names, (std::vector<std::string>{"oak_wood", "edge"}));
  // the picture is there once, however many pieces have it
  ASSERT_EQ(glb.json["images"].size(), 1U);
  EXPECT_EQ(glb.json["images"][0]["mimeType"], "image/png");
  EXPECT_EQ(glb.View(glb.json["images"][0]["bufferView"]), kPng);
  fs::remove_all(root);
}

TEST(VisualDoor, AGlbThatIsImportedAgainHasTheSameMaterialsTexcoordsAndPictures) {
  const fs::path root = Folder("again");
  ImportBoxes(root);
  const DoorAsset door = ComposeDoor(Read(root, "leaf"), Read(root, "bar"), {});
  CommitFile(root / "door.glb", ToGlb(door));
  const ImportedMesh again = ImportMesh(root / "door.glb");
  EXPECT_TRUE(again.notes.empty()) << again.notes[0];
  EXPECT_EQ(again.pictures, std::vector<std::string>{kPng});
  int edges = 0;
  for (const ImportedPiece& piece : again.pieces) {
    const ImportedMaterial& material = again.materials.at(static_cast<std::size_t>(piece.material));
    EXPECT_EQ(material.picture >= 0, material.name == "oak_wood");
    EXPECT_EQ(piece.texcoord_triangles.size(), piece.mesh.triangles.size());
    if (material.name != "edge") continue;
    ++edges;
    EXPECT_LT((material.color_rgba - Eigen::Vector4d(0.2, 0.4, 0.6, 0.5)).norm(), 1e-6);
  }
  EXPECT_EQ(edges, 2);
  fs::remove_all(root);
}

TEST(VisualDoor, MirroredAndStretchedItIsStillSeenFromOutside) {
  const fs::path root = Folder("mirrored");
  ImportBoxes(root);
  const Part body = Read(root, "leaf");
  const DoorAsset left = ComposeDoor(body, Read(root, "bar"), {});
  const DoorAsset right = ComposeDoor(body, Read(root, "bar"), {.hinge_side = HingeSide::kRight});
  EXPECT_NEAR(SignedVolume(LeafOf(right).visual), SignedVolume(LeafOf(left).visual), 1e-6);
  Corners mirrored;
  for (const auto& [corner, count] : CornersOf(LeafOf(left).visual))
    mirrored[{corner[0], -corner[1], corner[2], corner[3], corner[4]}] = count;
  EXPECT_EQ(CornersOf(LeafOf(right).visual), mirrored);
  const DoorAsset wide = ComposeDoor(body, Read(root, "bar"), {.leaf_width_m = 1.35});
  EXPECT_NEAR(SignedVolume(LeafOf(wide).visual), 1.5 * SignedVolume(LeafOf(left).visual), 1e-6);
  const DoorAsset pushed =
      ComposeDoor(body, Read(root, "bar"), {.opening = Opening::kPush, .handle_turn_deg = 90});
  for (const DoorLink& link : pushed.links) {
    for (const DoorGeometry& geometry : link.geometry)
      EXPECT_NEAR(SignedVolume(geometry.visual), MeasureTopology(geometry.mesh).volume_m3, 1e-6);
  }
  fs::remove_all(root);
}

TEST(VisualDoor, DoorsThatShareMeshesShareThemToo) {
  const fs::path root = Folder("shared");
  ImportBoxes(root);
  const std::vector<PreparedPart> parts = {PreparedPart(Read(root, "leaf"), {}),
                                           PreparedPart(Read(root, "bar"), {})};
  WriteMeshPool(parts, root / "doors", 1);
  const std::vector<PartPair> pairs = {{0, 1}};
  const auto outcomes = WriteSharedDoors({parts, pairs, {}, Existing::kRefuse, 1}, root / "doors",
                                         [](std::size_t) {});
  ASSERT_EQ(outcomes.at(0).problem, "");
  const fs::path folder = root / "doors" / outcomes[0].id;
  const DoorAsset door = ReadDoor(folder);
  EXPECT_EQ(ContentHash(door), ContentHash(ComposeDoor(Read(root, "leaf"), Read(root, "bar"), {})));
  DoorIdentifier identifier;
  EXPECT_EQ(identifier.Identify(ReadJsonFile(folder / "door.json"), folder), IdentityOf(door));
  ASSERT_EQ(LeafOf(door).visual.surfaces.size(), 2U);
  const ValidationReport report = ValidateDoor(folder, ValidationProfile::kUrdf);
  EXPECT_EQ(report.errors, 0) << (report.findings.empty() ? "" : report.findings[0].measured);
  // one picture for both parts
  int pictures = 0;
  fs::path picture;
  for (const auto& entry : fs::directory_iterator(root / "doors/pool")) {
    if (entry.path().extension() != ".png") continue;
    ++pictures;
    picture = entry.path();
  }
  EXPECT_EQ(pictures, 1);
  CommitFile(picture, kPng + "x");
  EXPECT_THROW(ReadDoor(folder), Error);
  const ValidationReport changed = ValidateDoor(folder, ValidationProfile::kUrdf);
  ASSERT_FALSE(changed.findings.empty());
  EXPECT_EQ(changed.findings[0].code, "MSH004");
  fs::remove_all(root);
}

TEST(VisualDoor, ADamagedMaterialFileCostsColoursAndNoTriangle) {
  const fs::path root = Folder("damaged");
  const ImportReport report = ImportBoxes(
      root, {.materials = "Kd 1\nnewmtl oak wood\nKd red 0 nan\nmap_Kd ../../secret.png\n\x01\xff\n"
                          "newmtl edge\nKd 0.2 0.4 0.6 \nd no\n"});
  ASSERT_EQ(report.objects.at(0).outcome, ImportOutcome::kImported);
  std::string notes;
  for (const std::string& note : report.objects[0].notes) notes += note + "\n";
  EXPECT_NE(notes.find("\"box.mtl\", line 3: Kd needs three numbers"), std::string::npos) << notes;
  EXPECT_NE(notes.find("secret.png\" left out: no such file inside the folder"), std::string::npos)
      << notes;
  const VisualMesh visual = FindPiece(Read(root, "leaf"), "leaf")->visual;
  ASSERT_EQ(visual.surfaces.size(), 2U);
  EXPECT_EQ(visual.surfaces[0].material.texture, nullptr);
  EXPECT_EQ(visual.surfaces[1].material.color_rgba[3], 1);
  const ImportReport bmp = ImportBoxes(root, {.picture = "BM no picture"});
  ASSERT_EQ(bmp.objects.at(0).notes.size(), 1U);
  EXPECT_NE(bmp.objects[0].notes[0].find("is no PNG and no JPEG"), std::string::npos);
  // what no renderer could show is said now, by name, and not by each of them later
  std::string wide = kPng;
  wide.replace(16, 4, std::string("\0\0\xea\x60", 4));
  const std::string jpeg(
      "\xff\xd8\xff\xe0\0\x04"
      "ab\xff\xc0\0\x0b\x08\0\x02\0\0\x01\x01\x11\0\xff\xd9",
      23);
  for (const auto& [picture, why] :
       {std::pair{wide, "\"grain.png\" left out: has 60000 x 1 pixels"},
        {kPng.substr(0, 40), "\"grain.png\" left out: is a PNG that is damaged or cut off"},
        {jpeg, "\"grain.png\" left out: has 0 x 2 pixels"},
        {jpeg.substr(0, 20), "is a JPEG that is damaged or cut off"}}) {
    const ImportReport odd = ImportBoxes(root, {.picture = picture});
    ASSERT_EQ(odd.objects.at(0).notes.size(), 1U) << why;
    EXPECT_NE(odd.objects[0].notes[0].find(why), std::string::npos) << odd.objects[0].notes[0];
  }
  fs::remove_all(root);
}

TEST(VisualDoor, BothSidesOfASheetKeepTheirMaterials) {
  const fs::path root = Folder("sides");
  CommitFile(root / "in/sheet.mtl", "newmtl front\nKd 1 0 0\nnewmtl back\nKd 0 0 1\n");
  CommitFile(root / "in/sheet.obj",
             "mtllib sheet.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl front\nf 1 2 3\n"
             "usemtl back\nf 3 2 1\nf 2 1 3\nf 2 3 1\n");
  const ImportedMesh sheet = ImportMesh(root / "in/sheet.obj");
  ASSERT_EQ(sheet.pieces.size(), 1U) << "for repair each triangle is there once";
  EXPECT_EQ(sheet.pieces[0].color_rgba, Eigen::Vector4d(1, 0, 0, 1));
  EXPECT_EQ(sheet.pieces[0].mesh.triangles.size(), 1U);
  ASSERT_EQ(sheet.other_sides.size(), 1U);
  EXPECT_EQ(sheet.other_sides[0].color_rgba, Eigen::Vector4d(0, 0, 1, 1));
  EXPECT_EQ(sheet.other_sides[0].mesh.triangles.size(), 1U);
  fs::remove_all(root);
}

TEST(VisualDoor, PicturesOutsideTheFolderAreNotOpened) {
  const fs::path root = Folder("outside");
  ImportBoxes(root);
  CommitFile(root / "secret.png", kPng + "secret");
  fs::remove(root / "in/grain.png");
  fs::create_symlink(root / "secret.png", root / "in/grain.png");
  const ImportedMesh linked = ImportMesh(root / "in/leaf.obj");
  EXPECT_TRUE(linked.pictures.empty());
  ASSERT_EQ(linked.notes.size(), 1U);
  // what holds object and pictures may be named as the folder to stay in
  CommitFile(root / "in/box.mtl", "newmtl oak wood\nmap_Kd ../secret.png\n");
  EXPECT_TRUE(ImportMesh(root / "in/leaf.obj").pictures.empty());
  EXPECT_EQ(ImportMesh(root / "in/leaf.obj", {.files_below = root}).pictures.size(), 1U);
  EXPECT_TRUE(ImportMesh(root / "in/leaf.obj", {.max_picture_bytes = 8, .files_below = root})
                  .pictures.empty());
  fs::remove_all(root);
}

TEST(VisualDoor, MuJoCoLoadsADoorWhoseAuthorDrewAnOpenLeaf) {
  const fs::path root = Folder("open");
  ImportBoxes(root, {.open = true});
  const DoorAsset door = ComposeDoor(Read(root, "leaf"), Read(root, "bar"), {});
  EXPECT_TRUE(ClosedMesh::From(LeafOf(door).mesh));
  const DoorFormat formats[] = {*DoorFormatNamed("urdf"), *DoorFormatNamed("mjcf"),
                                *DoorFormatNamed("usda")};
  WriteExportedDoor(door, formats, root / "door", Existing::kRefuse);
  const MuJoCoDoor urdf(root / "door/model.urdf");
  EXPECT_TRUE(urdf.ok()) << urdf.error();
  const MuJoCoDoor mjcf(root / "door/model.xml");
  EXPECT_TRUE(mjcf.ok()) << mjcf.error();
  const std::string usda = ReadFile(root / "door/model.usda");
  const auto& texture = *LeafOf(door).visual.surfaces[0].material.texture;
  EXPECT_NE(usda.find("@./" + AuthoredTexturePath(texture) + "@"), std::string::npos);
  EXPECT_EQ(ReadFile(root / "door" / AuthoredTexturePath(texture)), kPng);
  for (const auto& [open, close] : {std::pair{'{', '}'}, {'(', ')'}, {'[', ']'}})
    EXPECT_EQ(std::count(usda.begin(), usda.end(), open),
              std::count(usda.begin(), usda.end(), close));
  fs::remove_all(root);
}

TEST(VisualDoor, OneColourOnAClosedMeshIsNotKeptTwice) {
  const fs::path root = Folder("plain");
  ImportBoxes(root, {.materials = "newmtl none\n"});
  EXPECT_TRUE(FindPiece(Read(root, "leaf"), "leaf")->visual.empty());
  ImportConfig without;
  without.visual = false;
  ImportBoxes(root, {}, without);
  EXPECT_TRUE(FindPiece(Read(root, "leaf"), "leaf")->visual.empty());
  fs::remove_all(root);
}

}  // namespace
}  // namespace doorforge
