// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/names.h"
#include "doorforge/schemas/part_identity.h"

namespace doorforge {

/// What lists, plans and reports say of a door.
struct DoorIdentity {
  std::string id;
  Category category = Category::kInterior;
  Mechanism mechanism = Mechanism::kNone;
  PartIdentity body;
  PartIdentity handle;
  std::string sha256;   ///< ContentHash of the door.
  std::string license;  ///< SPDX expression of its parts.

  /// Every member of it and of its parts is equal.
  bool operator==(const DoorIdentity& other) const;
};

/// Writes all meshes as text to hash them.
DoorIdentity IdentityOf(const DoorAsset& door);

/// A door with the hash of its content, which was found once, when the door was read: whoever needs
/// the hash later need not write the meshes as text again.
struct IdentifiedDoor {
  std::shared_ptr<const DoorAsset> door;
  std::string sha256;  ///< ContentHash(*door).

  const DoorAsset& operator*() const { return *door; }
  const DoorAsset* operator->() const { return door.get(); }
};

/// Finds the identities of many doors that share meshes: what a mesh of the pool hashes to where it
/// lies in the door is remembered, so that few are read more than once. Safe to use from several
/// threads.
class DoorIdentifier {
 public:
  /// IdentityOf(ReadDoor(folder)) for the parsed door.json of the folder. A mesh that the doors
  /// before shared is not read again, so that its damage shows when the door itself is read. Throws
  /// as ReadDoor().
  DoorIdentity Identify(const nlohmann::ordered_json& record, const std::filesystem::path& folder);

  struct ReadResult {
    DoorAsset door;
    DoorIdentity identity;
  };
  /// ReadDoor(folder) and IdentityOf() it. All meshes are read and checked against the record;
  /// those that the doors before shared are not written as text and hashed again. Throws as
  /// ReadDoor().
  ReadResult Read(const std::filesystem::path& folder);

 private:
  class Recording;

  std::string HashOfDoor(const Recording& recording);

  std::mutex mutex_;
  std::map<std::string, std::string> known_;  ///< Hash of a placed mesh, by mesh and place.
};

}  // namespace doorforge
