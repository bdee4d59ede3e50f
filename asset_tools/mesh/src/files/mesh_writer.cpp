// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/mesh/mesh_writer.h"

#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstdint>

#include <Eigen/Geometry>

#include "doorforge/core/error.h"

namespace doorforge {
namespace {

static_assert(std::endian::native == std::endian::little, "STL and PLY are written as they lie");

template <class Value>
void PutRaw(std::string& content, const Value& value) {
  content.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void PutPoint(std::string& content, const Eigen::Vector3d& point) {
  for (const double coordinate : point) PutRaw(content, static_cast<float>(coordinate));
}

std::string Obj(const TriangleMesh& mesh) {
  std::string content;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    content += 'v';
    for (const double coordinate : vertex) {
      std::array<char, 32> digits{};
      // + 0 turns -0 into 0
      char* const end = std::to_chars(digits.data(), digits.data() + digits.size(),
                                      static_cast<float>(coordinate) + 0.0F)
                            .ptr;
      content.append(" ").append(static_cast<const char*>(digits.data()),
                                 static_cast<const char*>(end));
    }
    content += '\n';
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    content += 'f';
    for (const int index : t) content += ' ' + std::to_string(index + 1);
    content += '\n';
  }
  return content;
}

std::string Stl(const TriangleMesh& mesh) {
  std::string content(80, ' ');  // must not begin with "solid"
  PutRaw(content, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d& b = mesh.vertices[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d& c = mesh.vertices[static_cast<std::size_t>(t[2])];
    PutPoint(content, (b - a).cross(c - a).normalized());
    for (const Eigen::Vector3d& corner : {a, b, c}) PutPoint(content, corner);
    PutRaw(content, std::uint16_t{0});
  }
  return content;
}

std::string Ply(const TriangleMesh& mesh) {
  std::string content = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                        std::to_string(mesh.vertices.size()) +
                        "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                        std::to_string(mesh.triangles.size()) +
                        "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Eigen::Vector3d& vertex : mesh.vertices) PutPoint(content, vertex);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    PutRaw(content, std::uint8_t{3});
    for (const int index : t) PutRaw(content, index);
  }
  return content;
}

}  // namespace

MeshWriter WriterFor(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending == ".obj") return Obj;
  if (ending == ".stl") return Stl;
  if (ending == ".ply") return Ply;
  throw Error(ErrorCode::kInvalidArgument, path.string() + ": cannot write the ending \"" + ending +
                                               "\"; allowed .obj .stl .ply");
}

}  // namespace doorforge
