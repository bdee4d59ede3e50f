// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/schemas/door_identity.h"

namespace doorforge {

inline constexpr int kDoorIndexSchemaVersion = 1;

/// The file beside the folders of many doors that spares their readers to read and hash all meshes
/// before the first one is needed; see docs/design/door-index.md.
///
///     doors/door_index.json    schema doorforge.door_index
///     doors/<id>/door.json     found in the index by the SHA-256 of its bytes
///
/// An entry is bound to the bytes of a door.json and to nothing else: no path, no time, no name of
/// a folder. A door that was changed, added, renamed or taken away can therefore never be given the
/// entry of another one; what has no entry is read in full.
inline constexpr const char* kDoorIndexFile = "door_index.json";

class DoorIndex {
 public:
  DoorIndex() = default;
  /// `path` names the record. Throws Error(kFormat), also if two entries are of one door.json.
  static DoorIndex FromJson(const nlohmann::ordered_json& json, const std::string& path);

  /// Null if the index has no entry for a door.json of these bytes.
  const DoorIdentity* Find(const std::string& record_sha256) const;
  std::size_t size() const { return doors_.size(); }
  /// The keys are the SHA-256 of each door.json.
  const std::map<std::string, DoorIdentity>& doors() const { return doors_; }

  void Add(const std::string& record_sha256, DoorIdentity identity);
  /// Returns one door a line, the same text in whatever order the doors were added.
  std::string ToText() const;

 private:
  std::map<std::string, DoorIdentity> doors_;  ///< The keys are the SHA-256 of each door.json.
};

/// The index in a folder of doors; an empty one if there is none. Throws Error(kIo or kFormat) that
/// names the file and says what to do.
DoorIndex ReadDoorIndex(const std::filesystem::path& folder);

/// Reads the doors in the folders directly below `folder` and commits their index. Doors that
/// cannot be read are left out; whoever uses them is told why. The same bytes for any number of
/// threads. Progress is shown on standard error.
void WriteDoorIndex(const std::filesystem::path& folder, int threads);

}  // namespace doorforge
