// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <cstring>

#include "read/raw_mesh.h"

namespace doorforge::foreign {
namespace {

constexpr std::size_t kStlHeader = 84;
constexpr std::size_t kStlTriangle = 50;

std::uint32_t StlCount(std::string_view bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kStlHeader) std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

void RequireStlCount(std::string_view bytes) {
  if (bytes.size() < kStlHeader) throw RawMeshFault(0, "the file ends inside its header");
  const std::size_t count = StlCount(bytes);
  if (bytes.size() != kStlHeader + count * kStlTriangle)
    throw RawMeshFault(0, "its header says " + std::to_string(count) + " triangles, which is " +
                              std::to_string(kStlHeader + count * kStlTriangle) +
                              " bytes; the file has " + std::to_string(bytes.size()));
  if (count == 0) throw RawMeshFault(0, "no triangle in it");
  if (count > kMaxRawTriangles)
    throw RawMeshFault(0,
                       "more than the " + std::to_string(kMaxRawTriangles) + " triangles allowed");
}

TriangleMesh ReadBinaryStl(std::string_view bytes) {
  RequireStlCount(bytes);
  TriangleMesh mesh;
  const std::size_t count = StlCount(bytes);
  for (std::size_t i = 0; i < count; ++i) {
    float numbers[9];
    std::memcpy(numbers, bytes.data() + kStlHeader + i * kStlTriangle + 12, sizeof numbers);
    const int first = static_cast<int>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d corner(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]);
      if (!corner.allFinite())
        throw RawMeshFault(0, "triangle " + std::to_string(i) + " has a number that is not finite");
      mesh.vertices.push_back(corner);
    }
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

TriangleMesh ReadTextStl(std::string_view bytes) {
  TriangleMesh mesh;
  WordLines lines(bytes);
  int corners = 0;
  bool ended = false;
  while (lines.Next()) {
    const std::string_view kind = lines.Word();
    if (kind == "endsolid") ended = true;
    if (kind == "vertex") {
      Eigen::Vector3d corner;
      for (int k = 0; k < 3; ++k) corner[k] = lines.Number();
      mesh.vertices.push_back(corner);
      ++corners;
    }
    if (kind != "endloop") continue;
    if (corners != 3) lines.Fail("a loop of " + std::to_string(corners) + " vertices, expected 3");
    const int first = static_cast<int>(mesh.vertices.size()) - 3;
    AddFace({first, first + 1, first + 2}, lines.line(), mesh);
    corners = 0;
  }
  if (!ended || corners != 0) lines.Fail("the file ends before endsolid");
  if (mesh.triangles.empty()) lines.Fail("no triangle in it");
  return mesh;
}

}  // namespace

TriangleMesh ReadRawStl(std::string_view bytes) {
  // binary files may begin with the word, too; their size decides
  const bool fits = bytes.size() >= kStlHeader &&
                    bytes.size() == kStlHeader + std::size_t{StlCount(bytes)} * kStlTriangle;
  const bool text = bytes.substr(0, 5) == "solid" &&
                    bytes.substr(0, 1024).find("facet") != std::string_view::npos;
  return text && !fits ? ReadTextStl(bytes) : ReadBinaryStl(bytes);
}

}  // namespace doorforge::foreign
