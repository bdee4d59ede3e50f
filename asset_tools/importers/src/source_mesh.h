// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/parts/make_part.h"
#include "doorforge/schemas/urdf.h"

namespace doorforge::internal {

/// A mesh of a foreign object, not loaded yet, and where it goes.
struct SourceMesh {
  std::string piece;           ///< It is a RawPiece::name; empty while it is not known.
  std::filesystem::path file;  ///< Empty: `solid` is the mesh.
  /// Folder below which the file's materials and textures must lie; empty: the file's own.
  std::filesystem::path object_folder = {};
  std::string sha256;       ///< It hashes the file, or the canonical text of a solid.
  TriangleMesh solid = {};  ///< A box, cylinder or sphere of a URDF.
  /// Affine, in general a rigid motion and a scale, maybe with a reflection.
  Eigen::Affine3d part_from_raw = Eigen::Affine3d::Identity();
  std::optional<Eigen::Vector4d> color_rgba = {};  ///< Overrides the file's.
};

/// SHA-256 of a mesh file. Throws Error, naming it, where it is larger than any that is imported.
std::string HashOfMeshFile(const std::filesystem::path& file);

/// Loads one mesh into the part's frame; a reflection turns its triangles round.
TriangleMesh LoadMesh(const SourceMesh& mesh);

/// Pieces by name, in the order in which the names first occur; the colour of each is the mean of
/// its meshes' weighted by area, opaque; what its files draw is its visual mesh. Throws Error as
/// ImportMesh() does.
std::vector<RawPiece> LoadPieces(const std::vector<SourceMesh>& meshes);

TriangleMesh MeshOf(const UrdfBox& box);
TriangleMesh MeshOf(const UrdfCylinder& cylinder);
TriangleMesh MeshOf(const UrdfSphere& sphere);

/// SHA-256 over the meshes with their places (in micrometres) and everything in `part` that a
/// reader decides, and the masses that the source states, by piece.
std::string SourceHashOf(const std::vector<SourceMesh>& meshes, const Part& part,
                         const std::map<std::string, MassProperties>& masses = {});

/// Up to eight file names, then how many more.
std::string FileNamesOf(const std::vector<SourceMesh>& meshes);

}  // namespace doorforge::internal
