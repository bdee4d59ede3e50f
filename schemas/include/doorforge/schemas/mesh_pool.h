// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/visual_mesh.h"

namespace doorforge {

inline constexpr int kMeshPoolSchemaVersion = 1;

/// Meshes that the doors of one folder share: the folder `pool` beside the doors' folders.
///
///     doors/pool/pool.json                    marks the pool: schema doorforge.mesh_pool
///     doors/pool/<20 digits>.obj              a canonical mesh
///     doors/pool/<20 digits>.{mtl,png,jpg}    of the meshes that authors drew
///     doors/pool/<20 digits>.json             a shape: one mesh, its convex pieces, what its
///     author
///                                             drew
///     doors/<id>/door.json                    "mesh_pool": "../pool", shapes by their hash
///
/// Files are named by the first 20 hexadecimal digits of the SHA-256 of their bytes. Records give
/// the whole hash and never a path, and what is read is checked against it, so a door can name
/// nothing but pool files, and nobody can change one unnoticed.
inline constexpr const char* kMeshPoolPath = "../pool";

/// A closed mesh with its convex pieces, as the pool keeps them.
struct PooledShape {
  std::string mesh;                        ///< SHA-256 of the canonical text.
  std::vector<std::string> hulls;          ///< They name the convex hulls in order.
  std::optional<VisualFiles> visual = {};  ///< PooledVisualFiles() names what its author drew.
};

/// The files of a visual mesh as a pool holds them. Throws as ToTexts().
VisualFiles PooledVisualFiles(const VisualMesh& mesh);

/// "../pool/<20 digits>.obj". Throws Error(kFormat) unless `sha256` is 64 lower-case hexadecimal
/// digits.
std::string PooledMeshPath(const std::string& sha256);

/// Name of a pool's file: the first 20 digits and `extension` (".obj" or ".json"). Throws as above.
std::string PooledFileName(const std::string& sha256, const std::string& extension);

/// Text of a shape's record; its SHA-256 is the shape's name.
std::string ShapeText(const PooledShape& shape);
/// Text of pool.json.
std::string MeshPoolText();

/// The pool of a door's folder.
class MeshPool {
 public:
  /// `record` begins the messages. Throws Error(kMissing) if there is no pool beside the folder,
  /// and Error(kFormat) if it is a link or lacks pool.json of a known version.
  MeshPool(const std::filesystem::path& door_folder, std::string record);

  /// Throw Error(kMissing) where the pool lacks the file, Error(kFormat) where it is a link, is not
  /// what its hash says, or does not follow its format.
  PooledShape ReadShape(const std::string& sha256) const;
  TriangleMesh ReadMesh(const std::string& sha256) const;
  /// The bytes of a file that ReadShape() names; `path` gives its ending alone.
  std::string ReadRecorded(const RecordedFile& file) const;

  /// The mesh's file. Throws as ReadMesh(), but does not look into it.
  std::filesystem::path MeshFile(const std::string& sha256) const;

 private:
  std::filesystem::path FileOf(const std::string& sha256, const std::string& extension) const;
  std::string Read(const std::string& sha256, const std::string& extension) const;

  std::filesystem::path pool_;
  std::string record_;
};

/// Reads what authors drew for a door in `folder`: files below it, or of the pool beside it.
/// `record` begins the messages. Refuses changed files, paths that leave the folder, and links out
/// of it.
VisualReader DoorVisualReader(const std::filesystem::path& folder, const std::string& record);

}  // namespace doorforge
