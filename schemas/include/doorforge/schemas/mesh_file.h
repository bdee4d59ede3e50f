// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "doorforge/core/rigid_transform.h"
#include "doorforge/core/triangle_mesh.h"

namespace doorforge {

/// The canonical mesh file: Wavefront OBJ with only `v` and `f` lines, coordinates in metres,
/// each number the shortest decimal that reads back to the same float. Readable by every simulator.

/// Text of the canonical file; vertices are rounded to float. Deterministic.
std::string ToObj(const TriangleMesh& mesh);

/// Reads a canonical file. Throws Error(kMissing) if it does not exist and Error(kFormat), naming
/// file and line, on anything that ToObj() would not write and on a vertex out of reach.
TriangleMesh ReadObj(const std::filesystem::path& path);
/// Reads it from a text; `name` stands for the file in messages.
TriangleMesh ParseObj(std::string_view text, const std::string& name);

/// The mesh seen from frame a, with coordinates as canonical files hold them.
TriangleMesh PlacedAsFiled(TriangleMesh mesh, const RigidTransform& a_from_mesh);

/// Gives the mesh that a record names by its path relative to the record's folder and the SHA-256
/// of its canonical text. ReadPart() and ReadDoor() take one from whoever wants to count the meshes
/// that cannot be read and go on.
using MeshReader =
    std::function<TriangleMesh(const std::string& relative_path, const std::string& sha256)>;

}  // namespace doorforge
