// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "doorforge/core/committed_file.h"
#include "doorforge/exporters/export_door.h"

namespace doorforge {

/// How doors are exported.
struct ExportRun {
  std::filesystem::path out;               ///< Each door goes to OUT/<id>.
  std::vector<std::string> formats;        ///< Names of DoorFormats().
  std::vector<std::string> profiles = {};  ///< Of ExportProfiles(), whose formats are added.
  bool thumbnails = false;                 ///< A profile may want them anyway.
  ExportSettings settings = {};
  /// Draws the door in a folder as a PNG, for ExportSettings::thumbnail_png. This room draws
  /// nothing, so the program that can hands it in. It must bear several threads.
  std::function<std::string(const std::filesystem::path& folder)> draw = {};
  Existing existing = Existing::kRefuse;
  int threads = 0;  ///< 0: all processors; no byte depends on it.
};

/// What came of a door.
struct ExportedDoor {
  std::string folder;
  std::string id;       ///< Empty if its record could not be read.
  std::string problem;  ///< Why it could not be exported; empty if it could.
};

/// Exports the door in each folder, in the order given, with progress. Whatever is wrong with one,
/// the others go on.
///
/// @throws Error(kIo) if `out` cannot be written, or if of eight doors or more the files certainly
///     do not fit on its disk, by what four of them take; Error(kInvalidArgument) if neither a
///     format nor a profile is named, on an unknown name, and where pictures are wanted and `draw`
///     is empty.
std::vector<ExportedDoor> ExportDoors(std::span<const std::filesystem::path> folders,
                                      const ExportRun& run);

/// {"schema": "doorforge.export", "doors": [{"folder", "id", "exported", "message"}]}.
nlohmann::ordered_json ExportedToJson(std::span<const ExportedDoor> doors);

/// "<folder>: <why>" of each door that could not be exported.
std::vector<std::string> ProblemsOf(std::span<const ExportedDoor> doors);

}  // namespace doorforge
