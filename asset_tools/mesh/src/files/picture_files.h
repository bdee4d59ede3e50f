// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "doorforge/mesh/import_mesh.h"

namespace doorforge {

/// Resolves files that a mesh file names, which must lie below one folder, also where links lead.
class NamedFiles {
 public:
  /// `mesh` names them relative to its own folder.
  NamedFiles(const std::filesystem::path& mesh, const MeshImportLimits& limits);

  /// Where the file would be; nothing if it leaves the folder.
  std::optional<std::filesystem::path> Find(std::string_view name) const;
  bool IsBelow(const std::filesystem::path& file) const;

 private:
  std::filesystem::path folder_;
  std::filesystem::path root_;
};

/// Why bytes are no PNG or JPEG file that a renderer would show: another kind, cut off, without
/// pixels or with more than 16384 along a side. Empty where they are. Pixels are not decoded.
std::string PictureFault(std::string_view bytes);

/// Collects the pictures that materials name. What cannot be had becomes a note: a mesh without its
/// pictures is still a mesh.
class PictureFiles {
 public:
  PictureFiles(const std::filesystem::path& mesh, const MeshImportLimits& limits)
      : files_(mesh, limits), limits_(limits) {}

  /// Number of the picture, or -1. A name from another machine (absolute, with backslashes) stands
  /// for the file of that name beside the mesh.
  int Add(std::string_view name);
  /// Does so for a picture inside the mesh file.
  int AddEmbedded(const std::string& name, std::string_view bytes);

  void Note(std::string note);

  /// Hands over pictures and notes.
  void MoveTo(ImportedMesh& mesh);

 private:
  int Open(std::string_view name);
  int Keep(const std::string& name, std::string bytes);

  NamedFiles files_;
  MeshImportLimits limits_;
  std::uint64_t total_bytes_ = 0;
  std::map<std::string, int, std::less<>> number_of_;
  std::vector<std::string> pictures_;
  std::vector<std::string> notes_;
};

}  // namespace doorforge
