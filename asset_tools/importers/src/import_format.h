// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "doorforge/importers/foreign_object.h"

namespace doorforge::internal {

/// A foreign format. `knows` looks at names, and at the beginning of a file whose name says little;
/// `read` is as ReadObjects().
struct ImportFormat {
  std::string name;
  bool (*knows)(const std::filesystem::path& path);
  std::vector<ForeignObject> (*read)(const std::filesystem::path& path, const ReadConfig& config);
};

// A format a reader. A new one is declared here, listed below and named in CMakeLists.txt.
ImportFormat GaPartNetFormat();
ImportFormat PartNetMobilityFormat();
ImportFormat UniDoorManipFormat();
ImportFormat UniDoorManipPartsFormat();
ImportFormat Akb48Format();
ImportFormat DoorGymFormat();
ImportFormat UrdfFormat();
ImportFormat SdfFormat();
ImportFormat MjcfFormat();
ImportFormat UsdaFormat();
ImportFormat GlbFormat();
ImportFormat LooseMeshFormat();

/// All of them, in the order in which they are tried: later ones know less of what they look at.
inline constexpr ImportFormat (*kImportFormats[])() = {GaPartNetFormat,    PartNetMobilityFormat,
                                                       UniDoorManipFormat, UniDoorManipPartsFormat,
                                                       Akb48Format,        DoorGymFormat,
                                                       UrdfFormat,         SdfFormat,
                                                       MjcfFormat,         UsdaFormat,
                                                       GlbFormat,          LooseMeshFormat};

/// An id for a part (IdProblem() is empty): letters, digits, '-', '_' and '.' are kept, all else
/// becomes '-', and a text beyond 50 characters is cut and ends in digits of its hash.
std::string PartIdFrom(const std::string& text);

/// Returns the category that the config names, or `otherwise` where it names none. Throws
/// Error(kInvalidArgument) on an unknown category.
Category CategoryOr(const ReadConfig& config, Category otherwise);

}  // namespace doorforge::internal
