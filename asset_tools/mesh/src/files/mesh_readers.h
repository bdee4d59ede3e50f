// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "doorforge/mesh/import_mesh.h"

// The readers behind ImportMesh(). They run in the process doorforge-read-mesh only. All throw
// Error whose message leaves out the file's name, which ImportMesh() puts in front, and gives the
// line or byte where it is known.

namespace doorforge {

ImportedMesh ReadObjFile(const std::filesystem::path& path, const MeshImportLimits& limits);
ImportedMesh ReadStlFile(const std::filesystem::path& path, const MeshImportLimits& limits);
ImportedMesh ReadPlyFile(const std::filesystem::path& path, const MeshImportLimits& limits);

/// DAE, glTF, GLB, FBX, 3DS and OFF through assimp.
ImportedMesh ReadWithAssimp(const std::filesystem::path& path, const MeshImportLimits& limits);

}  // namespace doorforge
