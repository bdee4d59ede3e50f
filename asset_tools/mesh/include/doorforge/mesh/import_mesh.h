// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// What a mesh file may cost before it is refused. All limits are positive.
struct MeshImportLimits {
  std::uint64_t max_file_bytes = 512ULL << 20;
  std::uint64_t max_triangles = 5'000'000;  ///< Before duplicates are dropped.
  std::uint64_t memory_bytes = 4ULL << 30;  ///< Address space of the reading process.
  double timeout_s = 60;                    ///< Wall clock and processor time of that process.
};

/// The triangles of one material of one object in the file.
struct ImportedPiece {
  std::string name;   ///< Name of the object or node; empty where the file gives none.
  TriangleMesh mesh;  ///< Every vertex is used; no two vertices have the same position.
  /// Diffuse colour of the material, linear as in the file, each in [0, 1]; grey (0.8) where the
  /// file gives none. Textures are not read.
  Eigen::Vector4d color_rgba{0.8, 0.8, 0.8, 1.0};
};

/// A mesh file's triangles in metres, in the raw frame of the file.
struct ImportedMesh {
  std::vector<ImportedPiece> pieces;  ///< At least one, none empty, in the order of the file.
};

/// Reads OBJ, STL, PLY, DAE, glTF, GLB, FBX, 3DS or OFF, chosen by the file's ending (any case).
///
/// Faces are triangulated; lines and points are dropped, and so is any triangle with a repeated
/// position or with the same three positions, in either winding, as an earlier one of the file
/// (exporters repeat faces once per material). The transforms of nodes are baked in. Lengths become
/// metres by the unit that the file states (DAE, FBX; glTF is in metres by definition); OBJ, STL,
/// PLY, 3DS and OFF state none and are taken as metres. Axes stay exactly as in the file: a DAE
/// with Z_UP stays z up.
///
/// Files from outside never run in this process: the program doorforge-read-mesh reads them, under
/// limits on memory and time, and sends the triangles through a pipe, so a file that crashes or
/// hangs a reader is an Error like any other. That program is $DOORFORGE_READ_MESH if set, else it
/// lies beside the running one, else where doorforge was installed. Safe to call from several
/// threads. Deterministic.
///
/// @throws Error kMissing: no such file, or the reading program is not there; kFormat: an unknown
///     ending, content that does not follow its format, no triangle in it, or a limit exceeded;
///     kIo: the file cannot be read. The message names the file and, where known, the line.
///     kInvalidArgument: a limit is not positive.
ImportedMesh ImportMesh(const std::filesystem::path& path, const MeshImportLimits& limits = {});

/// All pieces as one mesh; vertices at the same position are one.
TriangleMesh MergedPieces(const ImportedMesh& mesh);

}  // namespace doorforge
