// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// Content of a mesh file; coordinates are rounded to float. OBJ: lines `v` and `f` only, shortest
/// decimals that read back the same. STL and PLY: binary, little-endian.
using MeshWriter = std::string (*)(const TriangleMesh& mesh);

/// The writer for .obj, .stl or .ply (any case). Throws Error(kInvalidArgument) on another ending.
MeshWriter WriterFor(const std::filesystem::path& path);

}  // namespace doorforge
