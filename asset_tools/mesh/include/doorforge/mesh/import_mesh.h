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

/// What a mesh file may cost before it is refused, and where it may look. All limits are positive.
struct MeshImportLimits {
  std::uint64_t max_file_bytes = 512ULL << 20;
  std::uint64_t max_triangles = 5'000'000;  ///< Before duplicates are dropped.
  /// Address space of the reading process. All that read at a time in this process have 2 GiB
  /// together, so more than that is 2 GiB.
  std::uint64_t memory_bytes = 2ULL << 30;
  double timeout_s = 60;  ///< Wall clock and processor time of that process.
  std::uint64_t max_picture_bytes = 32ULL << 20;  ///< Larger textures are left out.
  /// Materials, textures and buffers that the file names must lie below this folder, which holds
  /// the file; empty: the file's own folder.
  std::filesystem::path files_below = {};
};

/// The largest coordinate of an imported mesh, in the unit that it is in. Files in tenths of a
/// millimetre may state a hundred metres with it; what is larger is damage. Who knows the unit
/// checks again after scaling.
inline constexpr double kLargestRawCoordinate = 1e6;

/// Corners of one face, at most: cutting it into triangles takes time by their square.
inline constexpr std::size_t kMaxFaceCorners = 10'000;

/// A material that the file states.
struct ImportedMaterial {
  std::string name;  ///< May be empty.
  /// Diffuse colour and opacity as on a screen (sRGB), each in [0, 1]; what a texture is multiplied
  /// by.
  Eigen::Vector4d color_rgba{0.8, 0.8, 0.8, 1.0};
  int picture = -1;  ///< Into ImportedMesh::pictures; -1: no texture.
};

/// The triangles of one material of one object in the file.
struct ImportedPiece {
  std::string name;   ///< Name of the object or node; empty where the file gives none.
  TriangleMesh mesh;  ///< Every vertex is used; no two vertices have the same position.
  /// Colour of the material or, of PLY, the mean of the vertices'; grey (0.8) where the file gives
  /// none.
  Eigen::Vector4d color_rgba{0.8, 0.8, 0.8, 1.0};
  int material = -1;  ///< Into ImportedMesh::materials; -1: the file states none.
  /// Finite, (0, 0) at the picture's lower left; empty where the file gives none.
  std::vector<Eigen::Vector2d> texcoords = {};
  /// Into `texcoords`, one for each of mesh.triangles; empty where the file gives none.
  std::vector<Eigen::Vector3i> texcoord_triangles = {};
};

/// What a file, or the format it is in, says of the frame of its numbers.
struct FileFrame {
  std::string up = {};  ///< Axis that points up: "x", "y" or "z"; empty: nothing is said.
  /// Axis that points at who looks at the thing's front, such as "z" or "-y"; empty with `up`.
  std::string front = {};
  double unit_m = 1;         ///< Metres a unit, by which the lengths were multiplied.
  bool states_unit = false;  ///< Else that is what is assumed.
};

/// A mesh file's triangles in metres, in the raw frame of the file.
struct ImportedMesh {
  std::vector<ImportedPiece> pieces;  ///< At least one, none empty, in the order of the file.
  /// Triangles that repeat one of `pieces` the other way round, which some programs write to give
  /// the two sides of a sheet two materials. For what draws the mesh; all else does without.
  std::vector<ImportedPiece> other_sides = {};
  std::vector<ImportedMaterial> materials = {};
  std::vector<std::string> pictures = {};  ///< Bytes of PNG or JPEG files, without repetition.
  std::vector<std::string> notes = {};     ///< What of materials and textures was left out.
  FileFrame frame = {};
};

/// Reads OBJ, STL, PLY, DAE, glTF, GLB, FBX, 3DS or OFF, chosen by the file's ending (any case).
///
/// Faces are triangulated; lines and points are dropped, and so is any triangle with a repeated
/// position or with the same three positions, in either winding, as an earlier one of the file
/// (exporters repeat faces once per material). The transforms of nodes are baked in. Lengths become
/// metres by the unit that the file states (DAE, FBX; glTF is in metres by definition); OBJ, STL,
/// PLY, 3DS and OFF state none and are taken as metres. Axes stay exactly as in the file: a DAE
/// with Z_UP stays z up. ImportedMesh::frame says which axes these are, where the file (DAE: its
/// up_axis) or its format (glTF: y up, z to the front) does. A node whose transform is not finite
/// or flattens what it carries is refused by its name, and so is a unit that is no length.
///
/// Materials and the textures of their diffuse colour come along from OBJ with its MTL and from
/// everything that assimp reads, with the first set of texture coordinates. A fault in them costs
/// no triangle: what is missing, broken, too large or no PNG or JPEG is left out and noted. An
/// opacity of zero is taken for one, since exporters write it for what is meant to be seen.
///
/// Files from outside never run in this process: the program doorforge-read-mesh reads them, under
/// limits on memory and time, and sends the triangles through a pipe, so a file that crashes or
/// hangs a reader is an Error like any other. It inherits no descriptor and no environment, gains
/// no privileges, opens few files, starts nothing and ends when this process does. A read begins
/// with an eighth of the memory and waits its turn for all of it where that is too little, so what
/// is read beside a file changes nothing. That program is $DOORFORGE_READ_MESH if set, else it
/// lies beside the running one, else where doorforge was installed. Safe to call from several
/// threads. Deterministic.
///
/// @throws Error kMissing: no such file, or the reading program is not there; kFormat: an unknown
///     ending, content that does not follow its format, no triangle in it, a coordinate beyond
///     kLargestRawCoordinate, a face beyond kMaxFaceCorners, or a limit exceeded;
///     kIo: the file cannot be read. The message names the file and, where known, the line.
///     kInvalidArgument: a limit is not positive.
ImportedMesh ImportMesh(const std::filesystem::path& path, const MeshImportLimits& limits = {});

/// All pieces as one mesh; vertices at the same position are one.
TriangleMesh MergedPieces(const ImportedMesh& mesh);

}  // namespace doorforge
