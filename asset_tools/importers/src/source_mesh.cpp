// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "source_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "doorforge/core/error.h"
#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/core/mesh_transform.h"
#include "doorforge/mesh/import_mesh.h"
#include "doorforge/schemas/vertex_reach.h"
#include "doorforge/solids/solid.h"

#include "authored_mesh.h"

namespace doorforge::internal {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kRoundSegments = 32;
constexpr std::size_t kNamedFiles = 8;

// area of the triangles, which weighs their colour
double AreaOf(const TriangleMesh& mesh) {
  double area = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    area += (mesh.vertices[static_cast<std::size_t>(t[1])] - a)
                .cross(mesh.vertices[static_cast<std::size_t>(t[2])] - a)
                .norm() /
            2;
  }
  return area;
}

struct ColoredMesh {
  TriangleMesh mesh;
  Eigen::Vector4d color_area = Eigen::Vector4d::Zero();
  double area = 0;
};

TriangleMesh Moved(TriangleMesh mesh, const Eigen::Affine3d& to_from_mesh) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = to_from_mesh * vertex;
  if (to_from_mesh.linear().determinant() < 0) {
    for (Eigen::Vector3i& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

ImportedMesh ImportedFrom(const SourceMesh& source) {
  if (source.file.empty()) {
    ImportedPiece solid;
    solid.mesh = source.solid;
    solid.color_rgba = {0.7, 0.7, 0.7, 1};
    return {{std::move(solid)}};
  }
  MeshImportLimits limits;
  limits.files_below = source.object_folder;
  return ImportMesh(source.file, limits);
}

ColoredMesh Load(const SourceMesh& source, const ImportedMesh& imported) {
  ColoredMesh loaded;
  for (const ImportedPiece& piece : imported.pieces) {
    const double area = AreaOf(piece.mesh);
    loaded.color_area += area * piece.color_rgba;
    loaded.area += area;
  }
  loaded.mesh = source.file.empty() ? source.solid : MergedPieces(imported);
  if (source.color_rgba) loaded.color_area = loaded.area * *source.color_rgba;
  loaded.mesh = Moved(std::move(loaded.mesh), source.part_from_raw);
  RequireWithinReach(loaded.mesh.vertices, source.file.empty() ? "a shape" : source.file.string());
  return loaded;
}

RawPiece LoadPiece(const std::vector<SourceMesh>& meshes, const std::string& name) {
  std::vector<TriangleMesh> placed;
  Eigen::Vector4d color_area = Eigen::Vector4d::Zero();
  double area = 0;
  AuthoredMesh authored;
  RawPiece piece;
  for (const SourceMesh& mesh : meshes) {
    if (mesh.piece != name) continue;
    const ImportedMesh imported = ImportedFrom(mesh);
    ColoredMesh loaded = Load(mesh, imported);
    authored.Add(imported, mesh.part_from_raw, mesh.color_rgba);
    for (const std::string& note : imported.notes)
      piece.notes.push_back(mesh.file.filename().string() + ": " + note);
    placed.push_back(std::move(loaded.mesh));
    color_area += loaded.color_area;
    area += loaded.area;
  }
  piece.name = name;
  piece.mesh = Merged(placed);
  piece.visual = std::move(authored).Finish();
  if (area > 0) piece.color_rgba = color_area / area;
  piece.color_rgba[3] = 1;  // the sensor sees glass, as depth cameras would like to
  return piece;
}

Ring RingAt(double radius, double z) {
  Ring ring;
  for (int i = 0; i < kRoundSegments; ++i) {
    const double angle = 2 * std::numbers::pi * i / kRoundSegments;
    ring.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return ring;
}

void Add(Json& json, const Eigen::Vector3d& value) {
  // 1e-6: objects that share a part state it with different rounding
  for (const double number : value) json.push_back(std::llround(number * 1e6));
}

}  // namespace

std::string HashOfMeshFile(const std::filesystem::path& file) {
  const std::uint64_t most = MeshImportLimits().max_file_bytes;
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(file, error);
  if (error || size > most)
    throw Error(ErrorCode::kFormat,
                file.string() + ": " +
                    (error ? error.message()
                           : std::to_string(size) + " bytes, allowed " + std::to_string(most)));
  return Sha256OfFile(file);
}

TriangleMesh LoadMesh(const SourceMesh& mesh) { return Load(mesh, ImportedFrom(mesh)).mesh; }

std::vector<RawPiece> LoadPieces(const std::vector<SourceMesh>& meshes) {
  std::vector<RawPiece> pieces;
  for (const SourceMesh& mesh : meshes) {
    const bool known = std::any_of(pieces.begin(), pieces.end(),
                                   [&](const RawPiece& p) { return p.name == mesh.piece; });
    if (!known) pieces.push_back(LoadPiece(meshes, mesh.piece));
  }
  return pieces;
}

TriangleMesh MeshOf(const UrdfBox& box) { return BoxMesh(-box.size_m / 2, box.size_m / 2); }

TriangleMesh MeshOf(const UrdfCylinder& cylinder) {
  return Loft({RingAt(cylinder.radius_m, -cylinder.length_m / 2),
               RingAt(cylinder.radius_m, cylinder.length_m / 2)});
}

TriangleMesh MeshOf(const UrdfSphere& sphere) {
  std::vector<Ring> rings;
  constexpr int kRows = kRoundSegments / 2;
  for (int i = 1; i < kRows; ++i) {
    const double angle = std::numbers::pi * i / kRows;
    rings.push_back(RingAt(sphere.radius_m * std::sin(angle), -sphere.radius_m * std::cos(angle)));
  }
  return Loft(rings);
}

std::string SourceHashOf(const std::vector<SourceMesh>& meshes, const Part& part,
                         const std::map<std::string, MassProperties>& masses) {
  Json json = {{"role", NameOf(part.role)},
               {"category", NameOf(part.category)},
               {"mechanism", NameOf(part.mechanism)},
               {"license", part.license}};
  for (const Eigen::Vector3d& value :
       {part.joint.origin_m, part.joint.axis,
        Eigen::Vector3d(part.joint.lower_rad, part.joint.upper_rad, 0),
        Eigen::Vector3d(part.part_from_mount.translation()),
        Eigen::Vector3d(part.part_from_grasp.translation())})
    Add(json["facts"], value);
  for (const SourceMesh& mesh : meshes) {
    Json place = {mesh.piece, mesh.sha256};
    Add(place, mesh.part_from_raw.translation());
    for (int axis = 0; axis < 3; ++axis) Add(place, mesh.part_from_raw.linear().col(axis));
    json["meshes"].push_back(place);
  }
  for (const auto& [piece, mass] : masses) {
    Json stated = {piece, mass.mass_kg};
    Add(stated, mass.center_of_mass_m);
    for (int row = 0; row < 3; ++row) Add(stated, mass.inertia_kg_m2.row(row).transpose());
    json["masses"].push_back(stated);
  }
  return Sha256Hex(JsonText(json));
}

std::string FileNamesOf(const std::vector<SourceMesh>& meshes) {
  std::string names;
  std::size_t count = 0;
  for (const SourceMesh& mesh : meshes) {
    if (mesh.file.empty() || ++count > kNamedFiles) continue;
    if (!names.empty()) names += ' ';
    names += mesh.file.filename().string();
  }
  if (count > kNamedFiles) names += " and " + std::to_string(count - kNamedFiles) + " more";
  return names;
}

}  // namespace doorforge::internal
