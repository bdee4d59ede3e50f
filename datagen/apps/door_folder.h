// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "doorforge/datagen/door_split.h"
#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/door_asset.h"

namespace doorforge {

/// Composed doors, sorted by id: what identifies each, and where it lies. Their meshes stay on the
/// disk, see DoorShelf.
struct DoorFolder {
  std::vector<DatasetDoor> doors;  ///< Without their splits.
  std::vector<std::filesystem::path> paths;
};

/// Reads every folder at or below the named ones that holds a door.json. Among the names may be a
/// split, as a name in data/splits or a file, with a side: "full", "full:train", "my.yaml:test";
/// then only doors are meant whose body and handle are both on that side, by default "train".
///
/// @throws Error(kMissing) if there is none, Error(kFormat) that lists every door that cannot be
///     read, Error(kInvalidArgument) if two doors have one id, an unknown side or two splits.
DoorFolder ReadDoors(const std::vector<std::string>& names, int threads);

/// Where the doors of a record lie, in its order; those that are nowhere at or below the named
/// folders have an empty path. What is found is compared with the record when it is taken from a
/// DoorShelf.
///
/// @throws Error(kMissing) if there is no door at all, Error(kInvalidArgument) if none of the
/// record.
DoorFolder FindRecordedDoors(const std::vector<std::string>& names,
                             const std::vector<DatasetDoor>& recorded, int threads);

/// What the plan needs of the doors, in their order.
std::vector<DoorParts> PartsOf(const DoorFolder& folder);

/// Hash over all doors' ids and hashes.
std::string ContentHash(const DoorFolder& folder);

/// The doors of a folder, read when they are needed. At most a few stay in memory, whatever their
/// number. Safe to use from several threads.
class DoorShelf {
 public:
  /// Keeps a reference.
  explicit DoorShelf(const DoorFolder& folder) : folder_(folder) {}

  /// Door number `door` of the folder.
  ///
  /// @throws Error(kMissing, kIo or kFormat) if it can be read no more, or is not what it was when
  ///     the folder was read.
  std::shared_ptr<const DoorAsset> Take(std::size_t door);

 private:
  struct Place {
    std::shared_ptr<const DoorAsset> door;
    std::uint64_t taken_at = 0;
  };

  const DoorFolder& folder_;
  std::mutex mutex_;
  std::map<std::size_t, Place> places_;
  std::uint64_t clock_ = 0;
};

}  // namespace doorforge
