// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/schemas/door_asset.h"

// The record of a door and its meshes, one without the other.

namespace doorforge::internal {

/// SHA-256 of the files that WriteDoor() writes for one geometry.
struct GeometryHashes {
  std::string mesh;
  std::vector<std::string> hulls;
  std::optional<VisualFiles> visual;  ///< They hold what its author drew, if anything.
};
/// Indexed as DoorAsset::links and the geometry of each.
using DoorHashes = std::array<std::vector<GeometryHashes>, 3>;

/// The door of a parsed door.json in `folder`, as ReadDoor().
DoorAsset DoorFromRecord(const nlohmann::ordered_json& record, const std::filesystem::path& folder,
                         const MeshReader& read_mesh, const VisualReader& read_visual);

/// Reads meshes for a door in `folder`, of its own or of the pool beside it; `record` begins the
/// messages.
MeshReader DoorMeshReader(const std::filesystem::path& folder, const std::string& record);

/// ContentHash() of the door with the meshes of these hashes; those of `door` are not looked at.
std::string ContentHash(const DoorAsset& door, const DoorHashes& hashes);

/// The files of what an author drew for the geometry of this name; nothing where it is empty.
std::optional<VisualFiles> AuthoredFilesOf(const std::string& name, const VisualMesh& visual);

}  // namespace doorforge::internal
