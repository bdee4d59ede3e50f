// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "read/glb_file.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace doorforge::foreign {
namespace {

using Json = nlohmann::ordered_json;

// One triangle whose positions are zeros, 36 bytes in base64, and its three indices behind them.
Json Triangle() {
  const std::string content =
      "data:application/octet-stream;base64," + std::string(48, 'A') + "AAABAAIA";
  return {{"asset", {{"version", "2.0"}}},
          {"nodes", {{{"mesh", 0}}}},
          {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
          {"buffers", {{{"byteLength", 42}, {"uri", content}}}},
          {"bufferViews",
           {{{"buffer", 0}, {"byteLength", 36}},
            {{"buffer", 0}, {"byteOffset", 36}, {"byteLength", 6}}}},
          {"accessors",
           {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
            {{"bufferView", 1}, {"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}}}}};
}

struct Checked {
  TriangleMesh mesh;
  FaultList faults;
};

Checked Check(const Json& document) {
  Checked checked;
  checked.mesh = CheckGltf(document.dump(), "a.gltf", {}, checked.faults);
  return checked;
}

TEST(GlbFile, ATriangleIsRead) {
  const Checked checked = Check(Triangle());
  EXPECT_FALSE(checked.faults.HasError());
  EXPECT_EQ(checked.mesh.triangles.size(), 1U);
  EXPECT_EQ(checked.mesh.vertices.size(), 3U);
}

// Stride times count is 2^64 here: what wraps round to a place within the view must not be read.
TEST(GlbFile, AnAccessorWhoseEndIsBeyondAllNumbersIsRefused) {
  for (const int accessor : {0, 1}) {
    Json document = Triangle();
    document["bufferViews"][accessor]["byteStride"] = 1ULL << 36U;
    document["accessors"][accessor]["count"] = (1ULL << 28U) + 1;
    const Checked checked = Check(document);
    EXPECT_TRUE(checked.faults.Has("GLB003"));
    EXPECT_TRUE(checked.mesh.triangles.empty());
  }
}

// A hundred thousand nodes show a mesh of fifty thousand vertices and no triangle: 5e9 vertices.
TEST(GlbFile, VerticesOfNoTriangleAreCountedToo) {
  Json document = Triangle();
  constexpr int kVertices = 50'000;
  const std::string zeros(kVertices * 12 / 3 * 4, 'A');
  document["buffers"][0] = {{"byteLength", kVertices * 12},
                            {"uri", "data:application/octet-stream;base64," + zeros}};
  document["bufferViews"][0]["byteLength"] = kVertices * 12;
  document["accessors"][0]["count"] = kVertices;
  document["accessors"][1]["count"] = 1;
  document["nodes"] = Json(std::vector<Json>(100'000, {{"mesh", 0}}));
  const Checked checked = Check(document);
  EXPECT_TRUE(checked.faults.Has("FIL003"));
  EXPECT_LE(checked.mesh.vertices.size(), 15'000'000U);
}

// Each primitive looks at each position: the product is what takes time.
TEST(GlbFile, PositionsThatAreLookedAtAgainAndAgainAreCounted) {
  Json document = Triangle();
  constexpr int kVertices = 50'000;
  const std::string zeros(kVertices * 12 / 3 * 4, 'A');
  document["buffers"][0] = {{"byteLength", kVertices * 12},
                            {"uri", "data:application/octet-stream;base64," + zeros}};
  document["bufferViews"][0]["byteLength"] = kVertices * 12;
  document["accessors"][0]["count"] = kVertices;
  document["nodes"] = Json::array();
  document["meshes"][0]["primitives"] =
      Json(std::vector<Json>(100'000, {{"attributes", {{"POSITION", 0}}}}));
  EXPECT_TRUE(Check(document).faults.Has("FIL003"));
}

// A file of 16 MB may name another of 16 MB half a million times.
TEST(GlbFile, BuffersAreCountedTogether) {
  Json document = Triangle();
  document["buffers"] = Json(std::vector<Json>(100, {{"byteLength", 1}, {"uri", "a.bin"}}));
  FaultList faults;
  std::size_t read = 0;
  const BufferReader reader = [&](const ForeignFileName&) {
    ++read;
    return std::string(64 << 20, '\0');
  };
  CheckGltf(document.dump(), "a.gltf", reader, faults);
  EXPECT_TRUE(faults.Has("FIL003"));
  EXPECT_LE(read, 9U);
}

}  // namespace
}  // namespace doorforge::foreign
