// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "doorforge/schemas/door_identity.h"

#include <cstddef>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "doorforge/core/hash.h"
#include "doorforge/core/json_file.h"
#include "doorforge/schemas/mesh_pool.h"

#include "doors/door_record.h"

namespace doorforge {
namespace {

using internal::DoorHashes;
using internal::GeometryHashes;

DoorIdentity WithHash(const DoorAsset& door, std::string sha256) {
  return {.id = door.id,
          .category = door.category,
          .mechanism = door.mechanism,
          .body = door.body,
          .handle = door.handle,
          .sha256 = std::move(sha256),
          .license = door.license};
}

// Own meshes lie in their link's frame.
RigidTransform LinkFromFiles(const nlohmann::ordered_json& geometry, const std::string& path) {
  if (!geometry.contains("shape") || !geometry.contains("link_from_shape"))
    return RigidTransform::Identity();
  return TransformFromJson(geometry["link_from_shape"], path);
}

// Files of a pool are named by their content.
bool IsPooled(const std::string& path, const std::string& sha256) {
  return path.starts_with(std::string(kMeshPoolPath) + "/") && path == PooledMeshPath(sha256);
}

std::string KeyOf(const std::string& sha256, const RigidTransform& place) {
  const Eigen::Matrix4d& numbers = place.matrix();
  return sha256 + std::string(reinterpret_cast<const char*>(numbers.data()),
                              sizeof(double) * static_cast<std::size_t>(numbers.size()));
}

}  // namespace

bool DoorIdentity::operator==(const DoorIdentity& other) const {
  const auto members = [](const DoorIdentity& door) {
    return std::tie(door.id, door.category, door.mechanism, door.body.id, door.body.sha256,
                    door.body.shape, door.handle.id, door.handle.sha256, door.handle.shape,
                    door.sha256, door.license);
  };
  return members(*this) == members(other);
}

DoorIdentity IdentityOf(const DoorAsset& door) { return WithHash(door, ContentHash(door)); }

/// A door of a parsed record, with the files that the record names in the order in which a door's
/// reader asks for them.
class DoorIdentifier::Recording {
 public:
  enum class Meshes {
    kRead,      ///< The door has all of its meshes.
    kDeferred,  ///< The door has none; only those that HashOf() is asked about are read.
  };

  /// A mesh of the door.
  struct Mesh {
    std::string path;
    std::string sha256;
    RigidTransform place;        ///< In its link.
    const TriangleMesh& placed;  ///< Empty if meshes are deferred.
  };

  /// Keeps a reference to the record.
  Recording(const nlohmann::ordered_json& record, const std::filesystem::path& folder,
            Meshes meshes)
      : path_((folder / "door.json").string()),
        record_(record),
        meshes_(meshes),
        read_mesh_(internal::DoorMeshReader(folder, path_)),
        read_visual_(DoorVisualReader(folder, path_)) {
    const bool reads = meshes_ == Meshes::kRead;
    door_ = internal::DoorFromRecord(
        record, folder,
        [this, reads](const std::string& path, const std::string& sha256) {
          files_.push_back({path, sha256});
          return reads ? read_mesh_(path, sha256) : TriangleMesh();
        },
        [this, reads](const VisualFiles& files) {
          // belongs to the geometry whose meshes were asked for last
          visuals_.emplace(files_.size(), files);
          return reads ? read_visual_(files) : VisualMesh();
        });
  }

  const DoorAsset& door() const { return door_; }
  DoorAsset TakeDoor() { return std::move(door_); }

  /// `hash` gives that of a mesh.
  template <class Hash>
  DoorHashes Hashes(Hash&& hash) const {
    DoorHashes hashes;
    std::size_t next = 0;
    for (std::size_t link = 0; link < hashes.size(); ++link) {
      auto entry = record_["links"][link]["geometry"].begin();
      for (const DoorGeometry& geometry : door_.links[link].geometry) {
        const RigidTransform place = LinkFromFiles(*entry++, path_ + ".link_from_shape");
        const auto hash_next = [&](const TriangleMesh& placed) {
          const RecordedFile& file = files_.at(next++);
          return hash(Mesh{file.path, file.sha256, place, placed});
        };
        GeometryHashes& found = hashes[link].emplace_back();
        found.mesh = hash_next(geometry.mesh);
        for (const TriangleMesh& hull : geometry.hulls) found.hulls.push_back(hash_next(hull));
        const auto visual = visuals_.find(next);
        if (visual == visuals_.end()) continue;
        found.visual = internal::AuthoredFilesOf(
            geometry.name, meshes_ == Meshes::kRead
                               ? geometry.visual
                               : PlacedAsFiled(read_visual_(visual->second), place));
      }
    }
    return hashes;
  }

  std::string HashOf(const Mesh& mesh) const {
    if (meshes_ == Meshes::kRead) return Sha256Hex(ToObj(mesh.placed));
    return Sha256Hex(ToObj(PlacedAsFiled(read_mesh_(mesh.path, mesh.sha256), mesh.place)));
  }

 private:
  std::string path_;
  const nlohmann::ordered_json& record_;
  Meshes meshes_;
  MeshReader read_mesh_;
  VisualReader read_visual_;
  DoorAsset door_;
  std::vector<RecordedFile> files_;
  std::map<std::size_t, VisualFiles> visuals_;
};

std::string DoorIdentifier::HashOfDoor(const Recording& recording) {
  const auto hash = [&](const Recording::Mesh& mesh) {
    // What is moved within its link, as roses are, lies elsewhere in the next door: to remember it
    // would only take memory.
    const bool is_moved = mesh.place.translation() != Eigen::Vector3d::Zero();
    if (is_moved || !IsPooled(mesh.path, mesh.sha256)) return recording.HashOf(mesh);
    const std::string key = KeyOf(mesh.sha256, mesh.place);
    {
      const std::scoped_lock lock(mutex_);
      const auto found = known_.find(key);
      if (found != known_.end()) return found->second;
    }
    std::string sha256 = recording.HashOf(mesh);
    const std::scoped_lock lock(mutex_);
    return known_.emplace(key, std::move(sha256)).first->second;
  };
  return internal::ContentHash(recording.door(), recording.Hashes(hash));
}

DoorIdentity DoorIdentifier::Identify(const nlohmann::ordered_json& record,
                                      const std::filesystem::path& folder) {
  const Recording recording(record, folder, Recording::Meshes::kDeferred);
  return WithHash(recording.door(), HashOfDoor(recording));
}

DoorIdentifier::ReadResult DoorIdentifier::Read(const std::filesystem::path& folder) {
  const nlohmann::ordered_json record = ReadJsonFile(folder / "door.json");
  Recording recording(record, folder, Recording::Meshes::kRead);
  DoorIdentity identity = WithHash(recording.door(), HashOfDoor(recording));
  return {recording.TakeDoor(), std::move(identity)};
}

}  // namespace doorforge
