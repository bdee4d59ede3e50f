// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/mesh_file.h"

#include <cmath>

#include "doorforge/core/committed_file.h"
#include "doorforge/core/error.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/schemas/vertex_reach.h"

#include "models/number_text.h"

namespace doorforge {
namespace {

using internal::AppendNumber;
using internal::LineCursor;

bool ReadVertex(std::string_view line, TriangleMesh& mesh) {
  float x = 0;
  float y = 0;
  float z = 0;
  LineCursor cursor(line);
  if (!cursor.NextNumber(x) || !cursor.NextNumber(y) || !cursor.NextNumber(z)) return false;
  if (!cursor.AtEnd()) return false;
  return IsWithinReach(mesh.vertices.emplace_back(x, y, z));
}

bool ReadFace(std::string_view line, TriangleMesh& mesh) {
  const int count = static_cast<int>(mesh.vertices.size());
  Eigen::Vector3i triangle;
  LineCursor cursor(line);
  for (int& index : triangle) {
    if (!cursor.NextNumber(index) || index < 1 || index > count) return false;
    --index;
  }
  mesh.triangles.push_back(triangle);
  return cursor.AtEnd();
}

bool ReadLine(std::string_view line, TriangleMesh& mesh) {
  if (line.empty() || line.starts_with('#') || line == "\r") return true;
  if (line.starts_with("v ")) return ReadVertex(line.substr(2), mesh);
  if (line.starts_with("f ")) return ReadFace(line.substr(2), mesh);
  return false;
}

// It says what is wrong with a line that ReadLine() refused.
std::string ProblemOf(std::string_view line, const TriangleMesh& mesh) {
  const bool is_vertex = line.starts_with("v ") && !mesh.vertices.empty();
  if (is_vertex && mesh.vertices.back().allFinite() && !IsWithinReach(mesh.vertices.back()))
    return BeyondReach(mesh.vertices.back());
  return "not a line of a canonical mesh; run `doorforge repair` on meshes from elsewhere";
}

}  // namespace

std::string BeyondReach(const Eigen::Vector3d& vertex) {
  std::string place;
  for (const double coordinate : vertex) {
    place += place.empty() ? "(" : ", ";
    AppendNumber(place, static_cast<float>(coordinate));
  }
  return "a vertex at " + place + ") m, allowed are coordinates up to " +
         std::to_string(std::lround(kFarthestVertexM)) +
         " m; is it in millimetres, or damaged? Give the unit where the mesh is imported";
}

void RequireWithinReach(std::span<const Eigen::Vector3d> vertices, const std::string& name) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!IsWithinReach(vertices[i]))
      throw Error(ErrorCode::kFormat,
                  name + ": vertex " + std::to_string(i + 1) + ": " + BeyondReach(vertices[i]));
  }
}

std::string ToObj(const TriangleMesh& mesh) {
  std::string text;
  text.reserve(mesh.vertices.size() * 40 + mesh.triangles.size() * 20);
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    text += 'v';
    for (const double coordinate : vertex) {
      text += ' ';
      AppendNumber(text, static_cast<float>(coordinate));
    }
    text += '\n';
  }
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    text += 'f';
    for (const int index : triangle) text += ' ' + std::to_string(index + 1);
    text += '\n';
  }
  return text;
}

TriangleMesh PlacedAsFiled(TriangleMesh mesh, const RigidTransform& a_from_mesh) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = RoundedToFloat(a_from_mesh * vertex);
  return mesh;
}

TriangleMesh ReadObj(const std::filesystem::path& path) {
  return ParseObj(ReadFile(path, 1ULL << 30), path.string());
}

TriangleMesh ParseObj(std::string_view text, const std::string& name) {
  TriangleMesh mesh;
  std::string_view rest = text;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    if (!ReadLine(line, mesh))
      throw Error(ErrorCode::kFormat,
                  name + ":" + std::to_string(number) + ": " + ProblemOf(line, mesh));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return mesh;
}

}  // namespace doorforge
