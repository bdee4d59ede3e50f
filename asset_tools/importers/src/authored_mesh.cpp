// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "authored_mesh.h"

#include <algorithm>
#include <utility>

#include "doorforge/core/mesh_transform.h"

namespace doorforge::internal {
namespace {

constexpr std::size_t kMaxName = 60;

// ASCII without blanks, so that every reader of MTL takes it
std::string WordFrom(const std::string& name) {
  std::string word = name.substr(0, kMaxName);
  std::replace_if(
      word.begin(), word.end(), [](unsigned char c) { return c <= ' ' || c > '~'; }, '_');
  return word.empty() ? "material" : word;
}

std::vector<std::shared_ptr<const VisualTexture>> TexturesFrom(const ImportedMesh& mesh) {
  std::vector<std::shared_ptr<const VisualTexture>> textures;
  for (const std::string& picture : mesh.pictures) textures.push_back(MakeVisualTexture(picture));
  return textures;
}

bool Same(const VisualMaterial& a, const VisualMaterial& b) {
  const std::string a_texture = a.texture == nullptr ? "" : a.texture->sha256;
  const std::string b_texture = b.texture == nullptr ? "" : b.texture->sha256;
  return a.color_rgba == b.color_rgba && a_texture == b_texture;
}

Eigen::Vector3i Turned(const Eigen::Vector3i& t, bool mirrored, int offset) {
  const Eigen::Vector3i moved = t + Eigen::Vector3i::Constant(offset);
  return mirrored ? Eigen::Vector3i(moved[0], moved[2], moved[1]) : moved;
}

}  // namespace

void AuthoredMesh::Add(const ImportedMesh& mesh, const Eigen::Affine3d& piece_from_mesh,
                       const std::optional<Eigen::Vector4d>& color_rgba) {
  const auto textures = TexturesFrom(mesh);
  for (const auto* pieces : {&mesh.pieces, &mesh.other_sides}) {
    for (const ImportedPiece& piece : *pieces) {
      VisualMaterial material{"", piece.color_rgba, nullptr};
      if (piece.material >= 0) {
        const auto& stated = mesh.materials[static_cast<std::size_t>(piece.material)];
        material = {stated.name, stated.color_rgba, nullptr};
        if (stated.picture >= 0)
          material.texture = textures[static_cast<std::size_t>(stated.picture)];
      }
      if (color_rgba) material = {"", color_rgba->cwiseMax(0.0).cwiseMin(1.0), nullptr};
      AddPiece(piece, piece_from_mesh, SurfaceOf(std::move(material)));
    }
  }
}

// A surface has texture coordinates for all of its triangles or for none.
void AuthoredMesh::AddPiece(const ImportedPiece& piece, const Eigen::Affine3d& piece_from_mesh,
                            VisualSurface& surface) {
  const bool mirrored = piece_from_mesh.linear().determinant() < 0;
  const bool textured = !piece.texcoord_triangles.empty();
  const std::size_t earlier = surface.triangles.size();
  const int first = static_cast<int>(mesh_.vertices.size());
  for (const Eigen::Vector3d& vertex : piece.mesh.vertices)
    mesh_.vertices.push_back(piece_from_mesh * vertex);
  for (const Eigen::Vector3i& t : piece.mesh.triangles)
    surface.triangles.push_back(Turned(t, mirrored, first));
  if (!textured && surface.texcoords.empty()) return;
  const int first_texcoord = static_cast<int>(mesh_.texcoords.size());
  mesh_.texcoords.insert(mesh_.texcoords.end(), piece.texcoords.begin(), piece.texcoords.end());
  if (!textured) mesh_.texcoords.emplace_back(0, 0);
  surface.texcoords.resize(earlier, Eigen::Vector3i::Constant(first_texcoord));
  for (const Eigen::Vector3i& t : piece.texcoord_triangles)
    surface.texcoords.push_back(Turned(t, mirrored, first_texcoord));
  surface.texcoords.resize(surface.triangles.size(), Eigen::Vector3i::Constant(first_texcoord));
}

VisualSurface& AuthoredMesh::SurfaceOf(VisualMaterial material) {
  const std::string wanted = WordFrom(material.name);
  for (std::size_t i = 0; i < mesh_.surfaces.size(); ++i) {
    if (wanted_names_[i] == wanted && Same(mesh_.surfaces[i].material, material))
      return mesh_.surfaces[i];
  }
  material.name = wanted;
  for (int count = 2; !names_.insert(material.name).second; ++count)
    material.name = wanted + "-" + std::to_string(count);
  wanted_names_.push_back(wanted);
  return mesh_.surfaces.emplace_back(VisualSurface{std::move(material), {}, {}});
}

VisualMesh AuthoredMesh::Finish() && {
  return PlacedAsFiled(std::move(mesh_), RigidTransform::Identity());
}

}  // namespace doorforge::internal
