// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "doorforge/importers/foreign_object.h"

#include "urdf_objects/hinged_object.h"

namespace doorforge::internal {

/// Which files of a PartNet-Mobility folder to read; GAPartNet puts others beside them.
struct PartNetFiles {
  std::string urdf = "mobility.urdf";
  std::string semantics = "semantics.txt";
  std::string name = "partnet-mobility";  ///< The format is called so.
  std::string id_prefix = "pm-";
  std::string source = "PartNet-Mobility";
  std::function<void(HingedObject&)> describe = {};  ///< Adds what other files say.
};

/// Reads the small files of an object. Joint types are those of `semantics`, which survives where
/// other projects fixed joints in the URDF that they did not need. Throws as ReadHingedObject().
HingedObject ReadPartNetFiles(const std::filesystem::path& folder, const PartNetFiles& files,
                              const ReadConfig& config);

/// The objects in those files. What the data set calls by a name that is no kind of door is refused
/// unless the config states a category.
std::vector<ForeignObject> ReadPartNetObject(const std::filesystem::path& folder,
                                             const PartNetFiles& files, const ReadConfig& config);

}  // namespace doorforge::internal
