// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "doorforge/core/mass_properties.h"
#include "doorforge/core/triangle_mesh.h"
#include "doorforge/schemas/mesh_file.h"
#include "doorforge/schemas/visual_mesh.h"

// Pieces that the codecs of parts and doors share.

namespace doorforge::internal {

using Json = nlohmann::ordered_json;

Json MassToJson(const MassProperties& mass);
MassProperties MassFromJson(const Json& json, const std::string& path);

Json ColorToJson(const Eigen::Vector4d& rgba);
Eigen::Vector4d ColorFromJson(const Json& json, const std::string& path);

/// {"path": relative path, "sha256": of the canonical text}.
Json MeshReference(const std::string& relative_path, const TriangleMesh& mesh);

/// Reads a mesh named by a record through `read_mesh`; `path` names the record.
TriangleMesh ReadReferencedMesh(const Json& reference, const MeshReader& read_mesh,
                                const std::string& path);

/// Reads canonical files below `folder`. Refuses absolute paths, "..", links out of the folder, and
/// a file whose SHA-256 is not the recorded one.
MeshReader ReaderBelow(const std::filesystem::path& folder, const std::string& path);

/// {"path", "sha256", "materials": {...}, "textures": [{...}]}
Json VisualToJson(const VisualFiles& files);
VisualFiles VisualFromJson(const Json& json, const std::string& path);

/// Where records keep visual meshes.
inline constexpr const char* kAuthoredFolder = "meshes/authored";
void WriteVisual(const VisualMesh& mesh, const std::string& name,
                 const std::filesystem::path& folder);

/// Reads visual meshes below `folder`. Refuses what ReaderBelow() refuses.
VisualReader VisualReaderBelow(const std::filesystem::path& folder, const std::string& path);

/// Throws Error(kFormat) if two of these pieces have one name: pieces lend their names to files.
void RequireOwnNames(const nlohmann::ordered_json& pieces, const std::string& path);

}  // namespace doorforge::internal
