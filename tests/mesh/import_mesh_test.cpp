// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/import_mesh.h"

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "doorforge/core/closed_mesh.h"
#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/program.h"

namespace doorforge {
namespace {

namespace fs = std::filesystem;

class ImportMeshTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(DOORFORGE_BINARY_DIR) / "import_mesh_test" / test->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path Write(const std::string& name, const std::string& content) const {
    CommitFile(folder_ / name, content);
    return folder_ / name;
  }

  ImportedMesh Import(const std::string& name, const std::string& content) const {
    return ImportMesh(Write(name, content));
  }

  // "code: message", the message without the folder; "" without an Error.
  std::string ErrorOf(const fs::path& path, const MeshImportLimits& limits = {}) const {
    try {
      ImportMesh(path, limits);
    } catch (const Error& error) {
      std::string message = error.what();
      if (const auto at = message.find(folder_.string()); at != std::string::npos)
        message.erase(at, folder_.string().size() + 1);
      return std::to_string(static_cast<int>(error.code())) + ": " + message;
    }
    return "";
  }

  std::string ErrorOf(const std::string& name, const std::string& content) const {
    return ErrorOf(Write(name, content));
  }

  fs::path folder_;
};

const std::string kFormat = std::to_string(static_cast<int>(ErrorCode::kFormat)) + ": ";
const std::string kMissing = std::to_string(static_cast<int>(ErrorCode::kMissing)) + ": ";

// A unit cube of quadrilaterals.
const std::string kCubeObj =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

template <class Value>
void Put(std::string& content, Value value, bool swap = false) {
  std::array<char, sizeof value> bytes{};
  std::memcpy(bytes.data(), &value, sizeof value);
  if (swap) std::reverse(bytes.begin(), bytes.end());
  content.append(bytes.data(), bytes.size());
}

std::string BinaryStl(const TriangleMesh& mesh, const std::string& header) {
  std::string content = header;
  content.resize(80, ' ');
  Put(content, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) Put(content, 0.0F);
    for (const int index : t) {
      for (const double x : mesh.vertices[static_cast<std::size_t>(index)])
        Put(content, static_cast<float>(x));
    }
    Put(content, std::uint16_t{0});
  }
  return content;
}

std::string BinaryPly(const TriangleMesh& mesh, bool big_endian) {
  std::string content =
      std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
      "_endian 1.0\ncomment made by a test\nelement vertex " +
      std::to_string(mesh.vertices.size()) +
      "\nproperty double x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face " +
      std::to_string(mesh.triangles.size()) +
      "\nproperty uchar flags\nproperty list uchar uint vertex_index\nend_header\n";
  for (const Eigen::Vector3d& v : mesh.vertices) {
    Put(content, v.x(), big_endian);
    Put(content, static_cast<float>(v.y()), big_endian);
    Put(content, static_cast<float>(v.z()), big_endian);
    content += std::string("\xff\x00\x33", 3);
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    content += std::string("\x07\x03", 2);
    for (const int index : t) Put(content, static_cast<std::uint32_t>(index), big_endian);
  }
  return content;
}

// Z_UP, a unit of 2 m, a node matrix with scale and shift, a line set, and each face twice.
const std::string kDae = R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="fathom" meter="2"/><up_axis>Z_UP</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="common"><lambert>
<diffuse><color>0.25 0.5 0.75 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g" name="panel"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 1 0 1 0 0 1</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<lines count="2" material="a"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 1 2</p></lines>
<triangles count="2" material="a"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2 0 2 3</p></triangles>
<triangles count="2" material="b"><input semantic="VERTEX" source="#v" offset="0"/><p>2 1 0 0 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="outer"><matrix>0.5 0 0 0 0 0.5 0 0 0 0 0.5 0 0 0 0 1</matrix>
<node id="inner"><matrix>1 0 0 10 0 1 0 20 0 0 1 30 0 0 0 1</matrix>
<instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="a" target="#m"/><instance_material symbol="b" target="#m"/>
</technique_common></bind_material></instance_geometry></node></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";

std::string Replaced(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

void ExpectUnitCube(const ImportedMesh& mesh) {
  const MeshTopology topology = MeasureTopology(MergedPieces(mesh));
  EXPECT_EQ(topology.boundary_edges + topology.non_manifold_edges + topology.inconsistent_edges, 0);
  EXPECT_NEAR(topology.volume_m3, 1, 1e-12);
  EXPECT_NEAR(topology.area_m2, 6, 1e-12);
}

TriangleMesh Cube() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TEST_F(ImportMeshTest, ReadsAnObjOfQuadrilaterals) {
  const ImportedMesh mesh = Import("cube.OBJ", kCubeObj);
  EXPECT_TRUE(mesh.frame.up.empty());
  EXPECT_FALSE(mesh.frame.states_unit);
  ASSERT_EQ(mesh.pieces.size(), 1U);
  EXPECT_EQ(mesh.pieces[0].mesh.vertices.size(), 8U);
  ExpectUnitCube(mesh);
}

TEST_F(ImportMeshTest, CountsNegativeIndicesBackFromTheLastVertex) {
  const ImportedMesh mesh = Import(
      "a.obj", "v 9 9 9\nv 0 0 0\nv 1 0 0 \\\n 0.5\r\nv +1 1 .5e0\nf -3/1/1 -2//7 -1 # corner\n");
  ASSERT_EQ(mesh.pieces[0].mesh.triangles.size(), 1U);
  EXPECT_EQ(mesh.pieces[0].mesh.vertices[2], Eigen::Vector3d(1, 1, 0.5));
}

TEST_F(ImportMeshTest, DropsRepeatedAndDegenerateTrianglesOfAnyWinding) {
  // the first face again from another corner, turned round, and from a vertex of its own, then a
  // doubled corner by index and by position
  const ImportedMesh mesh = Import(
      "a.obj", kCubeObj + "usemtl other\nf 4 1 2 3\nv 0 0 -0\nf 2 9 4 3\nf 1 1 2\nf 1 9 2\n");
  EXPECT_EQ(MergedPieces(mesh).triangles.size(), 12U);
}

TEST_F(ImportMeshTest, MakesAPieceOfEachObjectAndMaterialWithItsColour) {
  Write("colours.mtl", "newmtl red brick\nKd 0.8 0.1 0.2\nd 0.5\nnewmtl blue\nKd 0 0 7\n");
  const ImportedMesh mesh =
      Import("a.obj",
             "mtllib colours.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no left\n"
             "usemtl red brick\nf 1 2 3\nusemtl blue\nf 1 3 4\no right\nf 2 3 4\n");
  ASSERT_EQ(mesh.pieces.size(), 3U);
  EXPECT_EQ(mesh.pieces[0].name, "left");
  EXPECT_EQ(mesh.pieces[0].color_rgba, Eigen::Vector4d(0.8, 0.1, 0.2, 0.5));
  EXPECT_EQ(mesh.pieces[1].color_rgba, Eigen::Vector4d(0, 0, 1, 1));
  EXPECT_EQ(mesh.pieces[2].name, "right");
  EXPECT_EQ(MergedPieces(mesh).vertices.size(), 4U);
}

TEST_F(ImportMeshTest, DoesNotFollowAMaterialFileOutOfTheFolder) {
  Write("outside.mtl", "newmtl m\nKd 1 0 0\n");
  Write("inner/a.obj", "mtllib ../outside.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  EXPECT_EQ(ImportMesh(folder_ / "inner/a.obj").pieces[0].color_rgba, ImportedPiece{}.color_rgba);
}

TEST_F(ImportMeshTest, SplitsAConcavePolygonWithoutLeavingIt) {
  // an L of area 3 whose fan from the first corner would leave it
  const ImportedMesh mesh =
      Import("l.obj", "v 2 0 1\nv 2 0 2\nv 0 0 2\nv 0 0 0\nv 1 0 0\nv 1 0 1\nf 1 2 3 4 5 6\n");
  EXPECT_EQ(mesh.pieces[0].mesh.triangles.size(), 4U);
  EXPECT_NEAR(MeasureTopology(mesh.pieces[0].mesh).area_m2, 3, 1e-12);
}

TEST_F(ImportMeshTest, NamesTheLineOfABrokenObj) {
  EXPECT_EQ(ErrorOf("a.obj", "v 0 0 0\nf 1 2 3\n"),
            kFormat + "a.obj: line 2: a face names vertex 2, allowed 1..1");
  EXPECT_EQ(ErrorOf("a.obj", "v 0 0\n"), kFormat + "a.obj: line 1: a vertex needs three numbers");
  EXPECT_EQ(ErrorOf("a.obj", "v 0 0 nan\nv 1 0 0\nv 1 1 0\nf 1 2 3\n"),
            kFormat + "a.obj: line 4: a face uses a vertex that is not finite");
  EXPECT_EQ(ErrorOf("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"),
            kFormat + "a.obj: no triangle in the file");
}

TEST_F(ImportMeshTest, ReadsStlTextOfTwoSolids) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\n";
  const ImportedMesh mesh =
      Import("a.stl", "solid one\n" + facet + "endsolid one\nsolid two\n" +
                          Replaced(facet, "0 0 0\n", "0 0 5\n") + "endsolid\n");
  ASSERT_EQ(mesh.pieces.size(), 2U);
  EXPECT_EQ(mesh.pieces[1].name, "two");
}

TEST_F(ImportMeshTest, ReadsBinaryStlEvenIfItBeginsWithSolid) {
  ExpectUnitCube(Import("a.stl", BinaryStl(Cube(), "solid by CAD")));
}

TEST_F(ImportMeshTest, RefusesAnStlThatPromisesMoreThanItHas) {
  std::string content = BinaryStl(Cube(), "x");
  content.replace(80, 4, "\xff\xff\xff\xff");
  EXPECT_EQ(ErrorOf("a.stl", content),
            kFormat + "a.stl: its header promises 214748364834 bytes, the file has 684");
  EXPECT_EQ(ErrorOf("a.stl", "solid a\nfacet\nouter loop\nvertex 0 0 0\n"),
            kFormat + "a.stl: line 4: the file ends before its \"endsolid\"");
}

TEST_F(ImportMeshTest, ReadsBinaryPlyOfBothByteOrdersWithItsMeanColour) {
  for (const bool big_endian : {false, true}) {
    const ImportedMesh mesh = Import("a.ply", BinaryPly(Cube(), big_endian));
    ExpectUnitCube(mesh);
    EXPECT_LT((mesh.pieces[0].color_rgba - Eigen::Vector4d(1, 0, 0.2, 1)).norm(), 1e-12);
  }
}

TEST_F(ImportMeshTest, ReadsPlyText) {
  const ImportedMesh mesh =
      Import("a.ply",
             "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float "
             "y\nproperty float z\n"
             "element edge 1\nproperty int a\nproperty int b\nelement face 1\n"
             "property list uchar int vertex_indices\nend_header\n"
             "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 1\n4 0 1 2 3\n");
  EXPECT_NEAR(MeasureTopology(mesh.pieces[0].mesh).area_m2, 1, 1e-15);
}

TEST_F(ImportMeshTest, RefusesPlyCountsThatTheFileCannotHold) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
      "end_header\n0123";
  EXPECT_EQ(ErrorOf("a.ply", header),
            kFormat + "a.ply: 4000000000 elements \"vertex\" do not fit into the file");
  const std::string list =
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uint int vertex_indices\nend_header\n"
      "4000000000 1 2 3\n";
  EXPECT_TRUE(ErrorOf("a.ply", list).starts_with(kFormat + "a.ply: a list of length 4000000000"));
}

TEST_F(ImportMeshTest, NamesAnIndexThatNoMeshHas) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar double "
      "vertex_indices\nend_header\n";
  EXPECT_EQ(ErrorOf("a.ply", head + "3 7 0 0\n"),
            kFormat + "a.ply: a face names vertex 7, allowed 0..-1");
  EXPECT_EQ(ErrorOf("a.ply", head + "3 1e300 0 0\n"),
            kFormat + "a.ply: a face names vertex beyond all numbers, allowed 0..-1");
  EXPECT_EQ(ErrorOf("a.ply", head + "3 nan 0 0\n"),
            kFormat + "a.ply: a face names vertex that is no number, allowed 0..-1");
}

TEST_F(ImportMeshTest, BakesNodesAndUnitsOfADaeButKeepsItsAxes) {
  const ImportedMesh mesh = Import("a.dae", kDae);
  EXPECT_EQ(mesh.frame.up, "z");
  EXPECT_EQ(mesh.frame.front, "-y");
  EXPECT_EQ(mesh.frame.unit_m, 2);
  EXPECT_TRUE(mesh.frame.states_unit);
  const MeshTopology topology = MeasureTopology(MergedPieces(mesh));
  // (point + shift) / 2 * 2 m
  EXPECT_LT((topology.bounds.min() - Eigen::Vector3d(10, 20, 30)).norm(), 1e-6);
  EXPECT_LT((topology.bounds.max() - Eigen::Vector3d(11, 20, 31)).norm(), 1e-6);
  EXPECT_NEAR(topology.area_m2, 1, 1e-6);  // the second set repeats the first, and lines are none
  ASSERT_EQ(mesh.pieces.size(), 1U);
  EXPECT_LT((mesh.pieces[0].color_rgba - Eigen::Vector4d(0.25, 0.5, 0.75, 1)).norm(), 1e-6);
}

TEST_F(ImportMeshTest, TurnsFacesOfAMirroredNode) {
  const ImportedMesh plain = Import("a.dae", kDae);
  const ImportedMesh mirrored =
      Import("b.dae", Replaced(kDae, "<matrix>1 0 0 10", "<matrix>-1 0 0 10"));
  const auto facing = [](const ImportedMesh& mesh) {
    const TriangleMesh& m = mesh.pieces[0].mesh;
    const Eigen::Vector3i& t = m.triangles[0];
    return (m.vertices[static_cast<std::size_t>(t[1])] - m.vertices[static_cast<std::size_t>(t[0])])
        .cross(m.vertices[static_cast<std::size_t>(t[2])] -
               m.vertices[static_cast<std::size_t>(t[0])])
        .y();
  };
  // a mirror across x keeps y, so what faced -y still does
  EXPECT_LT(facing(plain), 0);
  EXPECT_LT(facing(mirrored), 0);
}

TEST_F(ImportMeshTest, RefusesADaeWithADoctype) {
  const std::string evil = Replaced(kDae, "<COLLADA", "<!DOCTYPE x [<!ENTITY a \"b\">]><COLLADA");
  EXPECT_EQ(ErrorOf("a.dae", evil),
            kFormat + "a.dae: a DOCTYPE or entity declaration is not allowed");
}

TEST_F(ImportMeshTest, ReadsAGltfButNotABufferOutsideItsFolder) {
  std::string buffer;
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) Put(buffer, x);
  for (const std::uint32_t i : {0U, 1U, 2U}) Put(buffer, i);
  Write("inner/b.bin", buffer);
  Write("outside.bin", buffer);
  const std::string gltf = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0, "translation": [0, 0, 2]}],
    "meshes": [{"name": "t", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "buffers": [{"uri": "b.bin", "byteLength": 48}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 12}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0]},
                  {"bufferView": 1, "componentType": 5125, "count": 3, "type": "SCALAR"}]})";
  const ImportedMesh mesh = ImportMesh(Write("inner/a.gltf", gltf));
  EXPECT_EQ(mesh.frame.up, "y");
  EXPECT_EQ(mesh.frame.front, "z");
  EXPECT_EQ(MeasureTopology(mesh.pieces[0].mesh).bounds.max(), Eigen::Vector3d(1, 1, 2));
  const std::string error =
      ErrorOf(Write("inner/evil.gltf", Replaced(gltf, "\"b.bin\"", "\"../outside.bin\"")));
  EXPECT_TRUE(error.starts_with(kFormat)) << "got: " << error;
}

TEST_F(ImportMeshTest, ReadsAnOff) {
  const ImportedMesh mesh = Import("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_NEAR(MeasureTopology(mesh.pieces[0].mesh).area_m2, 0.5, 1e-7);
}

TEST_F(ImportMeshTest, RefusesWhatIsNoMeshFile) {
  EXPECT_EQ(ErrorOf(folder_ / "none.obj"), kMissing + "none.obj: no such file");
  EXPECT_EQ(
      ErrorOf("a.txt", "x"),
      kFormat +
          "a.txt: unknown ending \".txt\"; allowed .obj .stl .ply .dae .gltf .glb .fbx .3ds .off");
  fs::create_directory(folder_ / "folder.obj");
  EXPECT_EQ(ErrorOf(folder_ / "folder.obj"),
            kFormat + "folder.obj: is a folder, expected a mesh file");
  ASSERT_EQ(::mkfifo((folder_ / "pipe.obj").c_str(), 0600), 0);
  EXPECT_EQ(ErrorOf(folder_ / "pipe.obj"),
            kFormat + "pipe.obj: is not a regular file, expected a mesh file");
  for (const char* ending : {"obj", "stl", "ply", "dae", "gltf", "glb", "fbx", "3ds", "off"})
    EXPECT_EQ(ErrorOf(std::string("empty.") + ending, ""),
              kFormat + "empty." + ending + ": the file is empty");
}

TEST_F(ImportMeshTest, HoldsItsLimits) {
  const fs::path cube = Write("cube.obj", kCubeObj);
  EXPECT_EQ(ErrorOf(cube, {.max_triangles = 11}),
            kFormat + "cube.obj: line 14: more than the 11 triangles allowed");
  EXPECT_EQ(ErrorOf(cube, {.max_file_bytes = 10}).substr(0, 3),
            std::to_string(static_cast<int>(ErrorCode::kIo)) + ": ");
  EXPECT_THROW(ImportMesh(cube, {.timeout_s = 0}), Error);
}

TEST_F(ImportMeshTest, SurvivesEveryTruncationOfEveryFormat) {
  const std::array<std::pair<std::string, std::string>, 5> files{
      {{"a.obj", kCubeObj},
       {"a.stl", BinaryStl(Cube(), "x")},
       {"b.ply", BinaryPly(Cube(), false)},
       {"c.dae", kDae},
       {"d.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}}};
  for (const auto& [name, content] : files) {
    for (std::size_t length = 1; length < content.size(); length += 1 + content.size() / 25) {
      const fs::path path = Write(name, content.substr(0, length));
      try {
        for (const ImportedPiece& piece : ImportMesh(path).pieces) MeasureTopology(piece.mesh);
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kFormat) << error.what();
        EXPECT_EQ(std::string(error.what()).find("crashed"), std::string::npos) << error.what();
      }
    }
  }
}

// Stands in for the reading program.
class FakeReader {
 public:
  FakeReader(const fs::path& folder, const std::string& script) {
    const fs::path program = folder / "reader.sh";
    CommitFile(program, "#!/bin/sh\n" + script + "\n");
    fs::permissions(program, fs::perms::owner_all);
    ::setenv("DOORFORGE_READ_MESH", program.c_str(), 1);
  }
  ~FakeReader() { ::unsetenv("DOORFORGE_READ_MESH"); }
};

TEST_F(ImportMeshTest, OutlivesAReaderThatCrashes) {
  const FakeReader reader(folder_, "kill -SEGV $$");
  EXPECT_EQ(ErrorOf("a.obj", kCubeObj),
            kFormat +
                "a.obj: the reader crashed on it (Segmentation fault); the file is broken, "
                "export it again or in another format");
}

TEST_F(ImportMeshTest, EndsAReaderThatHangs) {
  const FakeReader reader(folder_, "exec sleep 100");
  const fs::path path = Write("a.obj", kCubeObj);
  EXPECT_EQ(ErrorOf(path, {.timeout_s = 0.2}),
            kFormat + "a.obj: reading took longer than the time allowed");
}

TEST_F(ImportMeshTest, DoesNotTrustWhatAReaderSends) {
  const FakeReader reader(folder_, "printf 'DOFMESH1\\377\\377\\377\\377\\377\\377\\377\\177' >&3");
  EXPECT_EQ(ErrorOf("a.obj", kCubeObj),
            kFormat + "a.obj: the reader ended with exit code 0 and no result");
}

TEST_F(ImportMeshTest, GivesTheReaderNoDescriptorAndNoEnvironment) {
  const FakeReader reader(folder_, "/bin/ls /proc/$$/fd > '" + (folder_ / "fd").string() +
                                       "'; /bin/cat /proc/$$/environ > '" +
                                       (folder_ / "environ").string() + "'");
  const int open = ::open("/dev/null", O_RDONLY);  // inherited: without O_CLOEXEC
  ASSERT_EQ(::dup2(open, 57), 57);
  ::setenv("DOORFORGE_SECRET", "of the user", 1);
  ErrorOf("a.obj", kCubeObj);
  ::unsetenv("DOORFORGE_SECRET");
  ::close(57);
  ::close(open);
  EXPECT_EQ(ReadFile(folder_ / "environ"), "");
  const std::string descriptors = "\n" + ReadFile(folder_ / "fd");
  EXPECT_NE(descriptors.find("\n3\n"), std::string::npos) << descriptors;  // the pipe
  EXPECT_EQ(descriptors.find("\n57\n"), std::string::npos) << descriptors;
}

TEST_F(ImportMeshTest, ReadsAgainWithAllTheMemoryWhatNeedsMore) {
  const std::string log = (folder_ / "memory").string();
  const std::string real = (ProgramFolder() / "doorforge-read-mesh").string();
  {
    const FakeReader reader(folder_, "echo \"$4\" >> '" + log +
                                         "'; [ \"$4\" -gt 1000000000 ] || exit 4; " + "exec '" +
                                         real + "' \"$@\"");
    ExpectUnitCube(Import("cube.obj", kCubeObj));
    EXPECT_EQ(ReadFile(log), "268435456\n2147483648\n");
    fs::remove(log);
    // who allows less gets less, and no second try
    ErrorOf(folder_ / "cube.obj", {.memory_bytes = 100 << 20});
    EXPECT_EQ(ReadFile(log), "104857600\n");
  }
}

// The processes that this one has started.
std::vector<pid_t> Children(pid_t parent) {
  std::vector<pid_t> children;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream status(entry.path() / "status");
    for (std::string line; std::getline(status, line);) {
      if (line == "PPid:\t" + std::to_string(parent)) children.push_back(std::stoi(name));
    }
  }
  return children;
}

std::string TextOf(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A face whose corners lie on a circle.
std::string RoundFace(int corners) {
  std::string text;
  std::string face = "f";
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * 3.14159265358979 * i / corners;
    text += "v " + std::to_string(std::cos(angle)) + ' ' + std::to_string(std::sin(angle)) + " 0\n";
    face += ' ' + std::to_string(i + 1);
  }
  return text + face + "\n";
}

// A file that keeps its reader busy for a good while.
class BusyImport : public ImportMeshTest {
 protected:
  fs::path WriteSlow() const {
    std::string text = RoundFace(10000);
    const std::string again = text.substr(text.find('f'));
    for (int i = 0; i < 60; ++i) text += again;
    return Write("slow.obj", text);
  }

  // The process has started one reader, which is meant here.
  static pid_t ReaderOf(pid_t parent) {
    for (int i = 0; i < 2000; ++i) {
      for (const pid_t child : Children(parent)) {
        // the kernel keeps fifteen letters of a name
        const std::string status = TextOf("/proc/" + std::to_string(child) + "/status");
        if (status.starts_with("Name:\tdoorforge-read-")) return child;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return 0;
  }
};

TEST_F(BusyImport, TheReaderHasGivenUpItsRights) {
  const fs::path path = WriteSlow();
  std::jthread thread([&] { ErrorOf(path, {.timeout_s = 30}); });
  const pid_t reader = ReaderOf(::getpid());
  ASSERT_GT(reader, 0);
  const std::string process = "/proc/" + std::to_string(reader);
  std::string limits;
  // it gives them up in its first milliseconds
  for (int i = 0; i < 500 && limits.find("file size             0 ") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    limits = TextOf(process + "/limits");
  }
  EXPECT_NE(TextOf(process + "/status").find("NoNewPrivs:\t1"), std::string::npos);
  for (const char* limit :
       {"Max open files            64                   64",
        "Max core file size        0                    0",
        "Max file size             0                    0",
        "Max processes             0                    0", "Max cpu time              30"})
    EXPECT_NE(limits.find(limit), std::string::npos) << limit << "\n" << limits;
#if !defined(__SANITIZE_ADDRESS__)
  EXPECT_NE(limits.find("Max address space         268435456"), std::string::npos) << limits;
#endif
  ::kill(reader, SIGKILL);
}

TEST_F(BusyImport, TheReaderDiesWithItsParent) {
  const fs::path path = WriteSlow();
  const pid_t parent = ::fork();
  if (parent == 0) {
    try {
      ImportMesh(path);
    } catch (const Error&) {
    }
    ::_exit(0);
  }
  const pid_t reader = ReaderOf(parent);
  ASSERT_GT(reader, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  // however long it would take; a stopped process can be killed all the same
  ASSERT_EQ(::kill(reader, SIGSTOP), 0);
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  const std::string status = "/proc/" + std::to_string(reader) + "/status";
  for (int i = 0; i < 1000; ++i) {
    const std::string state = TextOf(status);
    if (state.empty() || state.find("State:\tZ") != std::string::npos) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ::kill(reader, SIGKILL);
  FAIL() << "the reader outlived its parent";
}

TEST_F(ImportMeshTest, RefusesCoordinatesBeyondAllUnits) {
  ExpectUnitCube(Import("cube.obj", kCubeObj));
  const std::string far = Replaced(kCubeObj, "v 1 1 1", "v 1 2e6 1");
  EXPECT_EQ(ErrorOf("far.obj", far),
            kFormat +
                "far.obj: line 10: a face uses a vertex with a coordinate of 2000000, allowed "
                "1000000; the file is damaged, or its unit is far too small");
  // a door of two metres in tenths of a millimetre
  EXPECT_EQ(ErrorOf("tenths.obj", Replaced(kCubeObj, "v 1 1 1", "v 1 20000 1")), "");
}

TEST_F(ImportMeshTest, RefusesAFaceOfMoreCornersThanProgramsWrite) {
  EXPECT_EQ(Import("most.obj", RoundFace(10000)).pieces[0].mesh.triangles.size(), 9998U);
  const std::string refusal = ErrorOf("more.obj", RoundFace(10001));
  EXPECT_EQ(refusal, kFormat +
                         "more.obj: line 10002: a face has 10001 corners, allowed 10000; export it "
                         "in triangles");
}

TEST_F(ImportMeshTest, WorksFromSeveralThreads) {
  const fs::path path = Write("cube.obj", kCubeObj);
  std::array<double, 8> volumes{};
  {
    std::vector<std::jthread> threads;
    for (double& volume : volumes)
      threads.emplace_back(
          [&] { volume = MeasureTopology(MergedPieces(ImportMesh(path))).volume_m3; });
  }
  for (const double volume : volumes) EXPECT_NEAR(volume, 1, 1e-12);
}

}  // namespace
}  // namespace doorforge
