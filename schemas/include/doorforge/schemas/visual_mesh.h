// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "doorforge/core/rigid_transform.h"

namespace doorforge {

enum class TextureFormat { kPng, kJpeg };

/// What the first bytes of a file say; empty where it is neither.
std::optional<TextureFormat> TextureFormatOf(std::string_view bytes);

inline constexpr std::uint64_t kMaxTextureBytes = 64ULL << 20;

/// A picture as its author's file holds it, never decoded.
struct VisualTexture {
  std::string bytes;
  std::string sha256;
  TextureFormat format = TextureFormat::kPng;
};

/// Throws Error(kFormat) unless `bytes` begin like a PNG or JPEG file, or if they are more than
/// kMaxTextureBytes.
std::shared_ptr<const VisualTexture> MakeVisualTexture(std::string bytes);

/// The first 20 hexadecimal digits of the SHA-256 with ".png" or ".jpg".
std::string FileNameOf(const VisualTexture& texture);

struct VisualMaterial {
  std::string name;  ///< Unique in its mesh, without blanks and control characters.
  /// sRGB and opacity, each in [0, 1]. A texture is multiplied by it.
  Eigen::Vector4d color_rgba{0.8, 0.8, 0.8, 1.0};
  std::shared_ptr<const VisualTexture> texture;  ///< Null: none.
};

/// The triangles of one material.
struct VisualSurface {
  VisualMaterial material;
  std::vector<Eigen::Vector3i> triangles;  ///< Into VisualMesh::vertices.
  /// Into VisualMesh::texcoords, one a triangle; empty: none of them has texture coordinates.
  std::vector<Eigen::Vector3i> texcoords;
};

/// What the author of a piece drew: triangles in any state (open, crossing, double) with materials.
/// For eyes and renderers alone; collision, mass and the depth camera take the closed mesh.
struct VisualMesh {
  std::vector<Eigen::Vector3d> vertices;   ///< [m]
  std::vector<Eigen::Vector2d> texcoords;  ///< (0, 0) is the lower left corner of the picture.
  std::vector<VisualSurface> surfaces;

  /// Nothing was kept; then the closed mesh in its colour is what is seen.
  bool empty() const { return surfaces.empty(); }
};

/// The mesh seen from frame a, with numbers as files hold them.
VisualMesh PlacedAsFiled(VisualMesh mesh, const RigidTransform& a_from_mesh);

/// The files of a visual mesh: Wavefront OBJ (`mtllib`, `v`, `vt`, `usemtl`, `f`), its MTL
/// (`newmtl`, `Kd`, `d`, `map_Kd`) and the pictures, all in one folder. The MTL and the pictures
/// are named by the first 20 digits of their SHA-256, and the OBJ names the MTL, so the hash of the
/// OBJ says which of them belong to it. Numbers are the shortest decimals that read back to the
/// same float.
struct VisualTexts {
  std::string mesh;
  std::string materials;
};
/// Deterministic. Throws Error(kInvalidArgument) on an index out of range, texture coordinates for
/// some triangles of a surface alone, or a material's name that is empty, used twice or has blanks.
VisualTexts ToTexts(const VisualMesh& mesh);

/// A file as a record names it.
struct RecordedFile {
  std::string path;  ///< Relative to the record's folder.
  std::string sha256;
};
/// Where a visual mesh lies.
struct VisualFiles {
  RecordedFile mesh;
  RecordedFile materials;
  std::vector<RecordedFile> textures;  ///< Without repetition, in the order of first use.
};

/// "<20 digits>.mtl" of the text of an MTL.
std::string MaterialFileName(const std::string& materials_text);

/// The pictures of a mesh without repetition, in the order of first use.
std::vector<std::shared_ptr<const VisualTexture>> TexturesOf(const VisualMesh& mesh);

/// Files in `folder` (relative, without a slash at the end), the OBJ called "<name>.obj". Throws as
/// ToTexts().
VisualFiles VisualFilesIn(const std::string& folder, const std::string& name,
                          const VisualMesh& mesh);

/// Gives the bytes of a recorded file. Whoever makes one decides which paths it accepts and whether
/// the hash must fit.
using FileReader = std::function<std::string(const RecordedFile& file)>;

/// Throws what `read` throws, and Error(kFormat), naming file and line, on anything that ToTexts()
/// would not write: an index out of range, a material or texture that the record does not name.
VisualMesh ReadVisualMesh(const VisualFiles& files, const FileReader& read);

/// Reads the visual mesh that a record names. ReadPart() and ReadDoor() take one from whoever wants
/// to count what cannot be read and go on.
using VisualReader = std::function<VisualMesh(const VisualFiles& files)>;

}  // namespace doorforge
