// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "doorforge/schemas/dataset.h"
#include "doorforge/schemas/door_asset.h"
#include "doorforge/schemas/door_identity.h"

namespace doorforge {

/// Which composed doors are meant.
struct DoorSelection {
  std::vector<std::filesystem::path> folders;  ///< Searched in depth for door.json.
  /// A split, as a name in data/splits or a file, with a side: "full:test", "my.yaml:train",
  /// "full:validation", "full:unseen_categories". Doors are meant whose body and handle are both on
  /// that side. Empty: all.
  std::string split = {};
  /// The side of a split that is named without one: "train" where data are collected, "test" where
  /// policies are judged. Empty: a split must be named with its side.
  std::string default_side = {};
  /// At most so many of each category, as DrawDoors() draws them; 0: all.
  int per_category = 0;
};

/// The selection that the words of a verb's --doors mean: folders, and at most one split.
///
/// @param default_side As DoorSelection::default_side; each verb's own.
/// @param split One that was given apart from the words; empty: none was.
/// @throws Error(kInvalidArgument) if there are two splits or no folder.
DoorSelection DoorSelectionOf(const std::vector<std::string>& words,
                              const std::string& default_side, const std::string& split = {});

/// A door that was found, without its meshes.
struct FoundDoor {
  DoorIdentity identity;
  std::filesystem::path folder;  ///< Empty: nowhere, see FindRecordedDoors().
  bool is_indexed = false;       ///< The identity is what a DoorIndex says.
};

/// Without a split.
DatasetDoor DatasetDoorOf(const DoorIdentity& identity);
/// Throws Error(kFormat) on an unknown category or mechanism.
DoorIdentity IdentityOf(const DatasetDoor& door);

/// The doors of a selection.
struct DoorSet {
  std::vector<FoundDoor> doors;  ///< Sorted by id.
  /// What whoever asked may not expect, a sentence each: a category of which the split leaves no
  /// door, or that has fewer doors than were asked for.
  std::vector<std::string> notes;
};

/// The doors of a selection; their meshes stay on the disk, see DoorCache. Of doors
/// with an entry in the index beside them no mesh is read and the entry is believed until the door
/// is taken from a shelf; the others are read in full, with a line of progress where they are many.
/// A door that is found twice counts once.
///
/// @throws Error(kMissing) if a folder does not exist or holds no door, or the selection means
///     none; Error(kFormat) that lists every door that cannot be read, or names an index that
///     cannot; Error(kInvalidArgument) on an unknown side, a negative number, or two different
///     doors with one id; as ReadSplit().
DoorSet FindDoorSet(const DoorSelection& selection, int threads);

/// Where the doors of a record lie, in its order; those that the selection does not find have an
/// empty folder. What is found is compared with the record when it is taken from a DoorCache.
///
/// @throws As FindDoorSet(), and Error(kInvalidArgument) if none of the record's doors is there.
std::vector<FoundDoor> FindRecordedDoors(const DoorSelection& selection,
                                         const std::vector<DatasetDoor>& recorded, int threads);

/// Gives a door by its number; called from several threads at once.
using DoorGiver = std::function<IdentifiedDoor(std::size_t)>;

/// The doors of a set, read when they are needed. At most 32 stay in memory, whatever their number.
/// Safe to use from several threads.
class DoorCache {
 public:
  /// Keeps a reference.
  explicit DoorCache(const std::vector<FoundDoor>& doors) : doors_(doors) {}
  explicit DoorCache(std::vector<FoundDoor>&&) = delete;  // it would be gone

  /// Door number `door` of the set.
  ///
  /// @throws Error(kMissing, kIo or kFormat) if it can be read no more, or is not what its identity
  ///     says: changed since then, or described wrongly by its index.
  IdentifiedDoor Take(std::size_t door);

 private:
  struct Place {
    std::shared_ptr<const DoorAsset> door;
    std::uint64_t taken_at = 0;
  };

  std::shared_ptr<const DoorAsset> Kept(std::size_t door);
  std::shared_ptr<const DoorAsset> Read(const FoundDoor& found);

  const std::vector<FoundDoor>& doors_;
  DoorIdentifier identifier_;
  std::mutex mutex_;
  std::map<std::size_t, Place> places_;
  std::uint64_t clock_ = 0;
};

}  // namespace doorforge
