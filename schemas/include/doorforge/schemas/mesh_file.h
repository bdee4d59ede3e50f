// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// The canonical mesh file: Wavefront OBJ with only `v` and `f` lines, coordinates in metres,
/// each number the shortest decimal that reads back to the same float. Readable by every simulator.

/// Text of the canonical file; vertices are rounded to float. Deterministic.
std::string ToObj(const TriangleMesh& mesh);

/// Reads a canonical file. Throws Error(kMissing) if it does not exist and Error(kFormat), naming
/// file and line, on anything that ToObj() would not write.
TriangleMesh ReadObj(const std::filesystem::path& path);

}  // namespace doorforge
