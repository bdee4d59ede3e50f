// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "page_content.h"

#include <cstring>

#include <gtest/gtest.h>
#include <zlib.h>

namespace doorforge::internal {
namespace {

struct Unpacked {
  nlohmann::json document;
  std::string bytes;
};

Unpacked Unpack(const std::string& packed) {
  std::string plain(1 << 20, '\0');
  uLongf size = plain.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(plain.data()), &size,
                       reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
            Z_OK);
  plain.resize(size);
  std::uint32_t length = 0;
  std::memcpy(&length, plain.data(), 4);
  return {nlohmann::json::parse(plain.substr(4, length)), plain.substr((4 + length + 3) / 4 * 4)};
}

TriangleMesh Tetrahedron(double size) {
  TriangleMesh mesh;
  mesh.vertices = {{0.1, -2, 0}, {0.1 + size, -2, 0}, {0.1, size - 2, 0.3}, {0.1, -2, size}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

TEST(PageContent, MeshReadsBackWithinHalfAStep) {
  PageContent content;
  const TriangleMesh mesh = Tetrahedron(0.7);
  ASSERT_EQ(content.AddMesh(mesh), 0U);
  const Unpacked read = Unpack(content.Packed());
  const auto& entry = read.document["meshes"][0];
  ASSERT_EQ(entry["vertices"], 4);
  ASSERT_EQ(entry["triangles"], 4);
  const char* at = read.bytes.data() + entry["at"].get<std::size_t>();
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    for (int i = 0; i < 3; ++i, at += 2) {
      std::uint16_t steps = 0;
      std::memcpy(&steps, at, 2);
      const double step = entry["step"][i];
      EXPECT_NEAR(entry["least"][i].get<double>() + steps * step, vertex[i], 0.5001 * step);
      EXPECT_LE(step, 0.7 / 65535 * 1.0001);
    }
  }
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i, at += 2) {
      std::uint16_t index = 0;
      std::memcpy(&index, at, 2);
      EXPECT_EQ(index, triangle[i]);
    }
  }
}

TEST(PageContent, EqualMeshesAreKeptOnce) {
  PageContent content;
  EXPECT_EQ(content.AddMesh(Tetrahedron(0.7)), 0U);
  EXPECT_EQ(content.AddMesh(Tetrahedron(0.8)), 1U);
  EXPECT_EQ(content.AddMesh(Tetrahedron(0.7)), 0U);
  EXPECT_EQ(content.document["meshes"].size(), 2U);
}

TEST(PageContent, EmptyAndFlatMeshesAreContent) {
  PageContent content;
  content.AddMesh({});
  TriangleMesh flat = Tetrahedron(1);
  for (Eigen::Vector3d& vertex : flat.vertices) vertex.z() = 0.25;
  content.AddMesh(flat);
  const Unpacked read = Unpack(content.Packed());
  EXPECT_EQ(read.document["meshes"][0]["vertices"], 0);
  EXPECT_EQ(read.document["meshes"][1]["least"][2], 0.25);
}

TEST(PageContent, BytesKeepTheirPlaces) {
  PageContent content;
  const auto first = content.AddBytes("abc");
  const auto second = content.AddBytes(std::string("\0\xff", 2));
  EXPECT_EQ(content.AddBytes("abc"), first);
  const Unpacked read = Unpack(content.Packed());
  EXPECT_EQ(read.bytes.substr(first["at"], first["bytes"]), "abc");
  EXPECT_EQ(read.bytes.substr(second["at"], second["bytes"]), std::string("\0\xff", 2));
}

TEST(Base64, IsThatOfRfc4648) {  // its section 10
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foo"), "Zm9v");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(Base64(std::string("\xff\xef\xbe", 3)), "/+++");
}

}  // namespace
}  // namespace doorforge::internal
