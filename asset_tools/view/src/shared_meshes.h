// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "doorforge/schemas/door_asset.h"

namespace doorforge::internal {

/// A mesh in the frame of its file, with the SHA-256 that its record gives.
struct FiledMesh {
  std::string sha256;
  std::shared_ptr<const TriangleMesh> mesh;
  RigidTransform link_from_mesh = RigidTransform::Identity();
};

/// A door without convex pieces; the meshes of its geometries are shared with other doors.
struct DoorOfShared {
  DoorAsset door;
  std::vector<std::vector<FiledMesh>> meshes;  ///< Indexed as its links and their geometries.
};

/// Reads doors of which many have the same meshes: each mesh once, by its SHA-256. Safe to use from
/// several threads. Keeps what it has read.
class SharedMeshes {
 public:
  /// Throws as ReadDoor(), but reads no convex pieces.
  DoorOfShared Read(const std::filesystem::path& folder);

 private:
  std::shared_ptr<const TriangleMesh> Take(const std::filesystem::path& folder,
                                           const std::string& relative, const std::string& sha256);

  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const TriangleMesh>> known_;
};

}  // namespace doorforge::internal
