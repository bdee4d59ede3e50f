// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "doorforge/catalogue/catalogue.h"
#include "doorforge/schemas/part.h"

namespace doorforge {

bool IsGlob(const std::string& name);

/// Where parts come from: the catalogue, or a folder of parts.
class PartStore {
 public:
  /// @param folder Empty: the catalogue. Throws Error(kMissing) if there is no such folder.
  explicit PartStore(const std::filesystem::path& folder);

  /// Names of all parts, in order.
  std::vector<std::string> All() const;
  /// Names that an id, a folder or a glob stands for; at least one. Throws Error(kMissing) if no
  /// part is called like the glob.
  std::vector<std::string> Matching(const std::string& wanted, PartRole role) const;
  /// Gives the folder of a part in files; it is empty for one of the catalogue.
  std::filesystem::path FolderOf(const std::string& name) const;
  /// Whether it is neither a part nor the name of one, but a file or folder to import.
  bool IsToImport(const std::string& name) const;
  /// Throws as ReadPart() and BuildCataloguePart().
  Part Load(const std::string& name) const;

 private:
  std::filesystem::path folder_;
  std::vector<RecipeFile> catalogue_;
  std::set<std::filesystem::path> folders_;
};

}  // namespace doorforge
